// The Python face of the components of an overlap. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bindings/interrupts.hpp"
#include "bindings/tuples.hpp"
#include "mesh_pair/mesh_pair.hpp"
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

}  // namespace satcheck
