// The Python face of the depth of concave pairs. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "bindings/interrupts.hpp"
#include "bindings/tuples.hpp"
#include "depth/depth_search.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

DepthInterval checked_search(const Surface& a, const Surface& b, double upper, double lower, double width,
                             std::uint64_t work, int across, double limit, Progress progress) {
  if (!(upper >= 0 && std::isfinite(upper))) throw std::invalid_argument("upper must be a finite length >= 0");
  if (!(lower >= 0 && std::isfinite(lower))) throw std::invalid_argument("lower must be a finite length >= 0");
  if (!(width >= 0 && width < 1)) throw std::invalid_argument("width must lie in 0 <= width < 1");
  if (across < -1 || across > 2) throw std::invalid_argument("across must be an axis, 0 to 2, or -1");
  if (!(limit > 0)) throw std::invalid_argument("limit must be a length > 0");
  if (a.mesh.triangles.empty() || b.mesh.triangles.empty()) throw std::invalid_argument("a surface is empty");
  return search_depth(a, b, {upper, lower, width, work, across, limit, polling(std::move(progress), work)});
}

const char* name_of(DepthStop stop) {
  return stop == DepthStop::narrow ? "narrow" : stop == DepthStop::decided ? "decided" : "work spent";
}

}  // namespace

void bind_depth(nb::module_& m) {
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
      .def_prop_ro("stop", [](const DepthInterval& d) { return name_of(d.stop); })
      .def_ro("work", &DepthInterval::work)
      .def_ro("boxes", &DepthInterval::boxes)
      .def_ro("mesh_tests", &DepthInterval::mesh_tests)
      .def_ro("sets", &DepthInterval::sets);
  m.def("search_depth", &checked_search, "a"_a, "b"_a, nb::kw_only(), "upper"_a, "lower"_a, "width"_a, "work"_a,
        "across"_a = -1, "limit"_a = INFINITY, "progress"_a.none() = nb::none(),
        nb::call_guard<nb::gil_scoped_release>(),
        R"(The depth of two overlapping meshes as a proven interval. The search ends when the interval is `width` wide, relative
to its upper end, or after `work` steps of about a nanosecond. upper: the length of a known way out; lower: a known
bound. across: for prisms along a world axis, this axis; translations are perpendicular to it; -1: none.
limit: the search also ends when the depth is proven to be at least this.
progress(lower, upper, share) is called now and then with the interval so far and the share of the work that is spent;
what it raises ends the search. The same input gives the same result on every machine. In the main thread a signal handler may raise, for example KeyboardInterrupt.
ValueError for a length that is negative or not finite, or for an empty surface.)");
}

}  // namespace satcheck
