// Decides which cells lie in which solid, and which shells bound the same cell.
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "overlap/space_cells.hpp"

namespace satcheck {

struct Windings {
  int a = 0, b = 0;
  bool operator==(const Windings&) const = default;
};

class ShellLabels {
 public:
  explicit ShellLabels(SpaceCells& cells);

  // Whether the winding numbers of each shell near both bodies are decided.
  bool complete() const { return complete_; }
  // Empty for shells away from one of the bodies.
  std::optional<Windings> of(std::uint32_t side) const;
  bool in_both(std::uint32_t side) const {
    const auto w = of(side);
    return w && w->a != 0 && w->b != 0;
  }

 private:
  template <class Point>
  bool note(std::uint32_t face, const Point& p);
  bool known(std::uint32_t face) const { return of(2 * face) && of(2 * face + 1); }

  SpaceCells& cells_;
  std::unordered_map<std::uint32_t, Windings> of_shell_;
  bool complete_ = true;
};

// Pairs of sides that a segment meets. Both sides of a pair bound the cell between them. The segment starts at a point
// of the side's face, on that side, and ends far away. Empty if no tried segment avoids all edges.
std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> sides_on_way(const SpaceCells& cells,
                                                                                 std::uint32_t side);

}  // namespace satcheck
