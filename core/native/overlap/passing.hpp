// Decides whether one body passes through the other.
//
// Pieces of both surfaces bound a component of the overlap. A passes through B if a piece of A joins two pieces of B: A
// enters through one and leaves through the other. Coincident faces belong to both surfaces or to none. If this
// matters, there is no answer.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "overlap/space_cells.hpp"

namespace satcheck {

inline constexpr std::uint32_t kNoComponent = 0xFFFFFFFF;

struct Passing {
  std::optional<bool> a_through_b, b_through_a;
};

// component: of each side, or kNoComponent. Result by component, of those where surfaces cross.
std::map<std::uint32_t, Passing> find_passing(const SpaceCells& cells, const std::vector<std::uint32_t>& component);

}  // namespace satcheck
