// The Python face of the depth of concave pairs. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "bindings/interrupts.hpp"
#include "bindings/values.hpp"
#include "convex/convex_hull.hpp"
#include "depth/depth_search.hpp"
#include "depth/inner_region.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

DepthInterval checked_depth(const Surface& a, const Surface& b, double upper, double lower, double width,
                            std::uint64_t work, int across, double limit, bool prove, Progress progress) {
  if (!(upper >= 0 && std::isfinite(upper))) throw std::invalid_argument("upper must be a finite length >= 0");
  if (!(lower >= 0 && std::isfinite(lower))) throw std::invalid_argument("lower must be a finite length >= 0");
  if (!(width >= 0 && width < 1)) throw std::invalid_argument("width must lie in 0 <= width < 1");
  if (across < -1 || across > 2) throw std::invalid_argument("across must be an axis, 0 to 2, or -1");
  if (!(limit > 0)) throw std::invalid_argument("limit must be a length > 0");
  if (a.mesh.triangles.empty() || b.mesh.triangles.empty()) throw std::invalid_argument("a surface is empty");
  return search_depth(a, b, {upper, lower, width, work, across, limit, prove, polling(std::move(progress), work)});
}

std::optional<Polytope> checked_region(const Surface& solid, const Tuple3& seed, const Polytope& within, const Polytope& like) {
  if (!solid.solid) throw std::invalid_argument("the surface is not a solid");
  if (within.dimension != 3 || like.dimension != 3) throw std::invalid_argument("within and like must be solid");
  const auto region = grow_inner_region(solid, finite_point(seed), metric_of(like.vertices), nullptr, &within);
  return region ? std::optional(convex_hull(region->vertices)) : std::nullopt;
}

}  // namespace

void bind_depth(nb::module_& m) {
  nb::class_<InnerRegion>(m, "InnerRegion", R"(The hull of points inside a solid. Each triangle of its surface is farther along one of the normals than all of them.)")
      .def_prop_ro("vertices", [](const InnerRegion& region) { return to_tuples(region.vertices); })
      .def_prop_ro("normals", [](const InnerRegion& region) { return to_tuples(region.normals); });
  nb::class_<OverlapSet>(m, "OverlapSet", R"(The hull of all differences of a point of region b and a point of region a, by its facets. corners: numbers of vertices
of a, and of b.)")
      .def_ro("a", &OverlapSet::a)
      .def_ro("b", &OverlapSet::b)
      .def_ro("corners", &OverlapSet::corners)
      .def_ro("facets", &OverlapSet::facets);
  nb::class_<DepthProof>(m, "DepthProof", R"(A cube of translations of a, in halves, and sets that hold all shorter ones than `upper`. Regions are in world
coordinates less the origin. half: of the edge of the cube. parts: in preorder; -1: halved across its longest edge, x before y
before z, the lower half first; -2: no translation in it is shorter; else the number of a set that holds it.)")
      .def_prop_ro("origin", [](const DepthProof& proof) { return to_tuple(proof.origin); })
      .def_ro("half", &DepthProof::half)
      .def_ro("sets", &DepthProof::sets)
      .def_ro("parts", &DepthProof::parts);
  nb::class_<DepthInterval>(m, "DepthInterval", R"(lower <= depth <= upper. way_out: a translation of a, `upper` long, after which the meshes have no common
interior; None: none is shorter than the known one. bound: the proven upper bound of the depth: `upper`
and the rounding of a's moved coordinates. stop: "narrow", "decided" (lower is at least the limit, up to rounding) or "work spent"; boxes
of translations, exact tests of the moved meshes, convex sets of forbidden translations: counts of the search.)")
      .def_ro("lower", &DepthInterval::lower)
      .def_ro("upper", &DepthInterval::upper)
      .def_ro("bound", &DepthInterval::bound)
      .def_prop_ro("way_out",
                   [](const DepthInterval& d) {
                     const Vec3 t = d.way_out;
                     return d.has_way_out ? std::optional(Tuple3{t.x, t.y, t.z}) : std::nullopt;
                   })
      .def_prop_ro("stop", [](const DepthInterval& d) { return name_of(d.stop); }, nb::sig(kStopSignature))
      .def_ro("work", &DepthInterval::work)
      .def_ro("boxes", &DepthInterval::boxes)
      .def_ro("mesh_tests", &DepthInterval::mesh_tests)
      .def_ro("sets", &DepthInterval::sets)
      .def_ro("proof", &DepthInterval::proof);
  m.def("inner_region", &checked_region, "solid"_a, "seed"_a, "within"_a, "like"_a, nb::call_guard<nb::gil_scoped_release>(),
        R"(A convex region that holds the seed, with no point of the surface of the solid in its interior; up to rounding it lies
within the polytope. like: it tends to the proportions of this one. None: the seed is not inside, or too close to the
surface to tell.)");
  m.def("search_depth", &checked_depth, "a"_a, "b"_a, nb::kw_only(), "upper"_a, "lower"_a, "width"_a, "work"_a,
        "across"_a = -1, "limit"_a = INFINITY, "prove"_a = false, "progress"_a.none() = nb::none(),
        nb::call_guard<nb::gil_scoped_release>(),
        R"(The depth of two overlapping meshes as a proven interval. The search ends when the interval is `width` wide, relative
to its upper end, or after `work` steps of about a nanosecond. upper: the length of a known way out; lower: a known
bound. across: for prisms along a world axis, this axis; translations are perpendicular to it; -1: none.
limit: the search also ends when the depth is proven to be at least this.
prove: writes down why no translation shorter than `upper` frees two solids, by regions inside them alone.
progress(lower, upper, share) is called now and then with the interval so far and the share of the work that is spent;
what it raises ends the search. The same input gives the same result on every machine. In the main thread a signal handler may raise, for example KeyboardInterrupt.
ValueError for a length that is negative or not finite, or for an empty surface.)");
}

}  // namespace satcheck
