// The Python face of the thickness of overlaps. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "bindings/interrupts.hpp"
#include "bindings/values.hpp"
#include "thickness/component_search.hpp"
#include "thickness/face_fit.hpp"
#include "thickness/shrunk.hpp"
#include "thickness/thickness_proof.hpp"
#include "thickness/thickness_search.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

std::optional<const char*> name_of(FaceFit fit) {
  switch (fit) {
    case FaceFit::deeper: return "deeper";
    case FaceFit::thin: return "thin";
    case FaceFit::fit: return "fit";
    default: return std::nullopt;
  }
}

std::pair<std::optional<const char*>, std::uint64_t> counted_fit(const Surface& a, const Surface& b, double length, std::uint64_t work) {
  Budget budget(work);
  const FaceFit fit = fit_by_faces(a, b, length, budget);
  return {name_of(fit), budget.spent()};
}

ThicknessInterval checked_thickness(const Surface& a, const Surface& b, double width, std::uint64_t work, double less_a,
                                    double less_b, std::optional<double> limit, double most, int across, bool prove,
                                    const OverlapComponent* within, unsigned threads, Progress progress) {
  if (!(width >= 0 && width < 1)) throw std::invalid_argument("width must lie in 0 <= width < 1");
  if (!(less_a >= 0 && std::isfinite(less_a))) throw std::invalid_argument("less_a must be a finite length >= 0");
  if (!(less_b >= 0 && std::isfinite(less_b))) throw std::invalid_argument("less_b must be a finite length >= 0");
  if (limit && !std::isfinite(*limit)) throw std::invalid_argument("limit must be finite");
  if (!(most > 0)) throw std::invalid_argument("most must be a length > 0");
  if (across < -1 || across > 2) throw std::invalid_argument("across must be an axis, 0 to 2, or -1");
  if (within != nullptr && prove) throw std::invalid_argument("within a component nothing is proven of the pair");
  const auto box = within != nullptr ? std::optional(box_around(*within)) : std::nullopt;
  return search_thickness(a, b, {width, work, less_a, less_b, limit, most, across, prove, box, threads, polling(std::move(progress), work)});
}

}  // namespace

void bind_thickness(nb::module_& m) {
  nb::class_<DepthBound>(m, "DepthBound", "Of the depth in body 0 or 1: the distance from triangles, or from a plane where there are none.")
      .def_ro("body", &DepthBound::body)
      .def_ro("triangles", &DepthBound::triangles)
      .def_prop_ro("normal", [](const DepthBound& bound) { return to_tuple(bound.plane.normal); })
      .def_prop_ro("height", [](const DepthBound& bound) { return bound.plane.height; })
      .def_ro("reach", &DepthBound::reach);
  nb::class_<ThicknessProof>(m, "ThicknessProof", "Cells that hold all that two bodies share, as a tree, and what bounds the depth in each.")
      .def_prop_ro("origin", [](const ThicknessProof& proof) { return to_tuple(proof.origin); })
      .def_prop_ro("low", [](const ThicknessProof& proof) { return to_tuple(proof.low); })
      .def_prop_ro("high", [](const ThicknessProof& proof) { return to_tuple(proof.high); })
      .def_ro("bounds", &ThicknessProof::bounds)
      .def_ro("cells", &ThicknessProof::cells)
      .def_ro("at", &ThicknessProof::at)
      .def_prop_ro("cuts",
                   [](const ThicknessProof& proof) {
                     std::vector<std::pair<Tuple3, double>> cuts;
                     for (const HalfSpace& cut : proof.cuts) cuts.emplace_back(to_tuple(cut.normal), cut.height);
                     return cuts;
                   })
      .def_ro("sums", &ThicknessProof::sums);
  nb::class_<ThicknessInterval>(m, "ThicknessInterval", R"(lower <= 2 max over p inside both of min(d_A(p) - less_a, d_B(p) - less_b) <= upper, rounding included. centre: a point
that is that deep, world frame; None where no common inner point is known. radius: no triangle of either surface is nearer to it.
stop: "narrow", "decided" (the interval lies on one side of the limit) or "work spent"; boxes of space that were bounded.)")
      .def_ro("lower", &ThicknessInterval::lower)
      .def_ro("upper", &ThicknessInterval::upper)
      .def_prop_ro("centre",
                   [](const ThicknessInterval& t) {
                     return t.found ? std::optional(to_tuple(t.centre)) : std::nullopt;
                   })
      .def_ro("radius", &ThicknessInterval::radius)
      .def_prop_ro("stop", [](const ThicknessInterval& t) { return name_of(t.stop); }, nb::sig(kStopSignature))
      .def_ro("work", &ThicknessInterval::work)
      .def_ro("boxes", &ThicknessInterval::boxes)
      .def_prop_ro("proof", [](const ThicknessInterval& t) { return t.proof ? std::optional(*t.proof) : std::nullopt; });
  m.def("component_balls", &component_balls, "a"_a, "b"_a, "overlap"_a, nb::call_guard<nb::gil_scoped_release>(),
        R"(The thickness of each component of the overlap of two solids, without a search. upper: that of its convex hull;
centre: of the largest ball in that; lower: how thick the overlap is around it, 0 where it does not lie in both, or may
belong to another component.)");
  m.def("fit_by_faces", &counted_fit, "a"_a, "b"_a, "length"_a, "work"_a, nb::call_guard<nb::gil_scoped_release>(),
        nb::sig("def fit_by_faces(a: Surface, b: Surface, length: float, work: int) -> "
                "tuple[typing.Literal['deeper', 'thin', 'fit'] | None, int]"),
        R"(Whether a ball thicker than `length`, > 0, lies in both solids, by the planes of faces that lie in each other, to the last
digits of float64. "deeper": one does. "thin": none does. "fit": none does, and wherever they meet both are thicker
than that, so that neither is a sheet or a wire that passes through the other. None: `work` steps, each about a
nanosecond, do not decide that. The number is of the steps that it took. Swapping a and b changes nothing. ValueError for a surface that is not a solid.)");
  const auto free = [](const Surface& a, const Surface& b, double most_a, double most_b) {
    return free_when_shrunk(a, b, most_a, most_b, interrupting());
  };
  m.def("free_when_shrunk", free, "a"_a, "b"_a, "most_a"_a, "most_b"_a, nb::call_guard<nb::gil_scoped_release>(),
        R"(Whether two solids are free of each other when each vertex moves into its body, by most_a or most_b at most. No point
is then deeper than that in both, and no point of one surface is deeper in the other body than the sum of both. False: not found.
Swapping a and b with their lengths changes nothing. ValueError for a surface that is not a solid.)");
  m.def("search_thickness", &checked_thickness, "a"_a, "b"_a, nb::kw_only(), "width"_a, "work"_a, "less_a"_a = 0.0,
        "less_b"_a = 0.0, "limit"_a = nb::none(), "most"_a = INFINITY, "across"_a = -1, "prove"_a = false, "within"_a.none() = nb::none(), "threads"_a = 1,
        "progress"_a.none() = nb::none(), nb::call_guard<nb::gil_scoped_release>(),
        R"(The diameter of the largest ball inside both of two solids as a proven interval, at most `width` wide relative to its
upper end unless `work` steps, each about a nanosecond, are spent first. less_a, less_b: taken from the distance to the surface
of a and of b. limit: the search ends as soon as the interval lies on one side of this length. most: the diameter is known to be no larger. across: an axis of the world along
which both solids are prisms: triangles across it do not count; -1: none. prove: write down why `upper` holds, not with an axis.
within: a component of the overlap: only its balls count, and others that have their centre in a box around it.
threads: 0 for one a core. progress(lower, upper, share) is called now and then with the interval so far and the share of
the work that is spent; what it raises ends the search. The same input gives the same result on every machine, with any number of threads.
Swapping a and b changes nothing. In the main thread a signal handler may raise, KeyboardInterrupt for one.
ValueError for a length that is negative or not finite, or for a surface that is not a solid.)");
}

}  // namespace satcheck
