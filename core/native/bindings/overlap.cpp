// The Python face of surfaces that meet, and of the components of an overlap. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>
#include <vector>

#include "bindings/interrupts.hpp"
#include "bindings/values.hpp"
#include "mesh_pair/covers_once.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "mesh_pair/surface_intersection.hpp"
#include "overlap/overlap_components.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {

void bind_overlap(nb::module_& m) {
  nb::class_<OverlapComponent>(m, "OverlapComponent", R"(A connected component of the overlap of two solids. bounds: least and greatest corner; point: of its
boundary, rounded. triangles: number of triangles that bound it; curves: along which the surfaces cross there;
curve_length: their total length. volume: in float64; volume_error: its approximate error. a_through_b: a connected piece of A's surface within B joins two pieces of B's surface within A, as
a pin through a plate joins the places where it enters and leaves; None: coincident faces leave it open, or
it is not resolved. resolved: False if a surface meets itself here.)")
      .def_prop_ro("bounds",
                   [](const OverlapComponent& c) { return std::make_pair(to_tuple(c.bounds.min), to_tuple(c.bounds.max)); })
      .def_prop_ro("point", [](const OverlapComponent& c) { return to_tuple(c.point); })
      .def_ro("triangles", &OverlapComponent::triangles)
      .def_ro("curves", &OverlapComponent::curves)
      .def_ro("curve_length", &OverlapComponent::curve_length)
      .def_ro("volume", &OverlapComponent::volume)
      .def_ro("volume_error", &OverlapComponent::volume_error)
      .def_ro("a_through_b", &OverlapComponent::a_through_b)
      .def_ro("b_through_a", &OverlapComponent::b_through_a)
      .def_ro("resolved", &OverlapComponent::resolved);
  nb::class_<OverlapComponents>(m, "OverlapComponents",
                                R"(components: by the least corner of their bounds. resolved: False if their number may differ. within_limits: False if
too many pairs of triangles meet, or if it takes more steps than a pair may; nothing is listed then.)")
      .def_ro("resolved", &OverlapComponents::resolved)
      .def_ro("within_limits", &OverlapComponents::within_limits)
      .def_ro("components", &OverlapComponents::components, nb::rv_policy::reference_internal);
  const auto described = [](const Surface& a, const Surface& b, std::size_t max_pairs) {
    Budget budget = budget_of_pair(a.mesh, b.mesh, interrupting());
    return overlap_components(a, b, max_pairs, Unresolved::described, &budget);
  };
  const auto passes = [](const Surface& a, const Surface& b, std::size_t max_pairs) {
    Budget budget = budget_of_pair(a.mesh, b.mesh, interrupting());
    return passes_through(a, b, max_pairs, &budget);
  };
  m.def("overlap_components", described, "a"_a, "b"_a, "max_pairs"_a, nb::call_guard<nb::gil_scoped_release>(),
        R"(The connected components of the overlap of two solids, by exact predicates. Surfaces that are not closed are not
resolved. max_pairs: limit on pairs of triangles that meet; more are not resolved. Swapping a and b only swaps the
fields of a and b.)");
  m.def("passes_through", passes, "a"_a, "b"_a, "max_pairs"_a, nb::call_guard<nb::gil_scoped_release>(),
        "Whether one of two solids passes through the other at a component of their overlap; None: not resolved.");
}

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
  m.def("has_sheets", &has_sheets, "solid"_a, "crack"_a, nb::call_guard<nb::gil_scoped_release>(),
        R"(Whether a piece of the surface has no inside on either side. Also true if a sample gives no answer. crack: the width
that makes no sheet.)");
}

}  // namespace satcheck
