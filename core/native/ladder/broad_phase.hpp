// Finds the close pairs among many boxes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

using IndexPair = std::array<std::uint32_t, 2>;

// A query for close pairs. reach: two boxes are close if their gap (world_box.hpp) is at most the sum of their reaches.
// kind: pairs of boxes whose kinds are in `exempt_kinds` are left out, and so are the pairs in `exempt`. In both lists
// the lower number comes first, and a kind may be paired with itself.
struct CloseQuery {
  std::vector<Aabb> boxes;
  std::vector<double> reach;
  std::vector<std::uint32_t> kind;
  std::vector<IndexPair> exempt_kinds, exempt;
};

// The close pairs i < j, sorted.
std::vector<IndexPair> close_pairs(CloseQuery query);

}  // namespace satcheck
