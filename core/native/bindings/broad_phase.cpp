// The Python face of the broad phase. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <stdexcept>
#include <utility>

#include "mesh/bvh.hpp"
#include "ladder/broad_phase.hpp"
#include "ladder/world_box.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

using Corner = std::array<double, 3>;
using Box = std::pair<Corner, Corner>;

Aabb to_aabb(const Box& box) {
  const auto& [low, high] = box;
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

using Pair = std::pair<std::uint32_t, std::uint32_t>;

ClosePairs close_pairs(const std::vector<Box>& boxes, std::vector<double> reach, std::vector<std::uint32_t> kinds,
                       std::vector<IndexPair> exempt_kinds, std::vector<IndexPair> exempt) {
  if (reach.size() != boxes.size() || kinds.size() != boxes.size()) {
    throw std::invalid_argument("boxes, reach and kinds differ in length");
  }
  const nb::gil_scoped_release release;
  CloseQuery query{{}, std::move(reach), std::move(kinds), std::move(exempt_kinds), std::move(exempt)};
  query.boxes.reserve(boxes.size());
  for (const Box& box : boxes) query.boxes.push_back(to_aabb(box));
  return ClosePairs(std::move(query));
}

// Keeps the GIL: two threads would take from one place.
std::vector<Pair> take(ClosePairs& close, std::size_t most) {
  std::vector<Pair> pairs;  // tuples in Python, where arrays would be lists
  for (const auto [i, j] : close.take(most)) pairs.emplace_back(i, j);
  return pairs;
}

}  // namespace

void bind_broad_phase(nb::module_& m) {
  m.def("box_gap", [](const Box& a, const Box& b) { return box_gap(to_aabb(a), to_aabb(b)); }, "a"_a, "b"_a,
        "A proven lower bound of the distance of two closed boxes ((x, y, z), (x, y, z)): 0.0 exactly when they meet.");
  m.def("order_along_curve",
        [](const std::vector<Box>& boxes) {
          std::vector<Aabb> aabbs;
          for (const Box& box : boxes) aabbs.push_back(to_aabb(box));
          return order_along_curve(aabbs);
        },
        "boxes"_a, nb::call_guard<nb::gil_scoped_release>(), "The numbers of the boxes along a curve on which neighbours are close: that of Morton, through their centres.");
  nb::class_<ClosePairs>(
      m, "ClosePairs",
      R"(Pairs (i, j), i < j, sorted, of boxes that are close: box_gap(boxes[i], boxes[j]) <= reach[i] + reach[j].

No close pair is missed but those left out on purpose: pairs of boxes whose kinds are in `exempt_kinds`, and
those in `exempt`; in both the lower number comes first. Time near n log n for n boxes of any sizes, where few
are close. Pairs are found as they are taken. ValueError when the lengths differ.)")
      .def(nb::new_(&close_pairs), "boxes"_a, "reach"_a, "kinds"_a, "exempt_kinds"_a = std::vector<IndexPair>{},
           "exempt"_a = std::vector<IndexPair>{})
      .def("take", &take, "most"_a = SIZE_MAX, "The next pairs, at most `most`; fewer only at the end.")
      .def("count", &ClosePairs::count, nb::call_guard<nb::gil_scoped_release>(),
           "The number of all close pairs, taken or not.");
}

}  // namespace satcheck
