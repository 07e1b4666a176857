// Does one body pass through the other?
//
// Each body bounds a component of the overlap by pieces of its surface. A passes through B where a piece of A joins two
// pieces of B: A enters through one and leaves through the other. Faces that lie in each other belong to both surfaces,
// or to none: where it matters which, there is no answer.
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
