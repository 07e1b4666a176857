// The Python face of surfaces that meet, each other or themselves. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>
#include <vector>

#include "bindings/interrupts.hpp"
#include "bindings/tuples.hpp"
#include "mesh_pair/covers_once.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "mesh_pair/surface_intersection.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

std::vector<Tuple3> to_tuples(const std::vector<Vec3>& points) {
  std::vector<Tuple3> tuples;
  tuples.reserve(points.size());
  for (Vec3 p : points) tuples.push_back(to_tuple(p));
  return tuples;
}

}  // namespace

void bind_contacts(nb::module_& m) {
  nb::class_<ContactCurve>(m, "ContactCurve", "A polyline that does not branch; a closed one does not repeat its first point.")
      .def_prop_ro("points", [](const ContactCurve& c) { return to_tuples(c.points); })
      .def_prop_ro("point_count", [](const ContactCurve& c) { return c.points.size(); })
      .def_ro("closed", &ContactCurve::closed)
      .def_ro("length", &ContactCurve::length);
  nb::class_<ContactPatch>(m, "ContactPatch",
                           R"(A flat polygon: the outer outline first, then its holes, counter-clockwise about `normal`, which is that of
a's surface, unit. opposed: whether the surfaces face each other there.)")
      .def_prop_ro("outlines",
                   [](const ContactPatch& p) {
                     std::vector<std::vector<Tuple3>> outlines;
                     for (const auto& outline : p.outlines) outlines.push_back(to_tuples(outline));
                     return outlines;
                   })
      .def_prop_ro("point_count",
                   [](const ContactPatch& p) {
                     std::size_t count = 0;
                     for (const auto& outline : p.outlines) count += outline.size();
                     return count;
                   })
      .def_prop_ro("normal", [](const ContactPatch& p) { return to_tuple(p.normal); })
      .def_ro("opposed", &ContactPatch::opposed)
      .def_ro("area", &ContactPatch::area);
  nb::class_<SurfaceIntersection>(m, "SurfaceIntersection",
                                  R"(The common points of two surfaces. curves: by decreasing length; patches: by decreasing area; points: isolated
ones. triangle_pairs: all that meet. complete: False if more pairs meet than allowed, or if it takes more steps than a
pair may; within_budget is False then. Nothing is listed in both cases.)")
      .def_ro("curves", &SurfaceIntersection::curves, nb::rv_policy::reference_internal)
      .def_ro("patches", &SurfaceIntersection::patches, nb::rv_policy::reference_internal)
      .def_prop_ro("points", [](const SurfaceIntersection& s) { return to_tuples(s.points); })
      .def_prop_ro("triangle_pairs",
                   [](const SurfaceIntersection& s) {
                     std::vector<std::tuple<std::uint32_t, std::uint32_t>> pairs;
                     pairs.reserve(s.triangle_pairs.size());
                     for (const ContactPair& p : s.triangle_pairs) pairs.emplace_back(p.a, p.b);
                     return pairs;
                   })
      .def_ro("complete", &SurfaceIntersection::complete)
      .def_ro("within_budget", &SurfaceIntersection::within_budget);
  const auto within_budget = [](const Surface& a, const Surface& b, std::size_t max_pairs) {
    Budget budget = budget_of_pair(a.mesh, b.mesh, interrupting());
    return surface_intersection(a, b, max_pairs, &budget);
  };
  m.def("surface_intersection", within_budget, "a"_a, "b"_a, "max_pairs"_a, nb::call_guard<nb::gil_scoped_release>(),
        R"(All common points of two placed surfaces. Which triangles meet and how the pieces join is decided by exact
predicates; points are exact intersections, each coordinate rounded once. Solid or not makes no difference.)");
  m.def("covers_once", &covers_once, "solid"_a, nb::call_guard<nb::gil_scoped_release>(),
        R"(Whether all winding numbers of the solid are 0 or 1, so that its signed volume is the volume that it covers. Exact
samples beside every piece of the surface decide.)");
  m.def("has_sheets", &has_sheets, "solid"_a, nb::call_guard<nb::gil_scoped_release>(),
        R"(Whether a piece of the surface has no inside on either side. Also true if a sample gives no answer.)");
}

}  // namespace satcheck
