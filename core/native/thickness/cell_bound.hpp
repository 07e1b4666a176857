// The largest depth of the points of a cell, from above.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "thickness/cell.hpp"
#include "thickness/thickness_proof.hpp"
#include "thickness/two_bodies.hpp"

namespace satcheck {

struct OpenCell {
  double bound = INFINITY;  // of the depth of its points
  Cell cell;
  std::shared_ptr<const PatchLists> near;        // patches that can be nearest to a point of it, and others; null: unknown
  std::array<std::optional<PatchList>, 2> met{};  // patches that may have a point in its interior, and others
  std::vector<Column> columns;                   // that the bound of the cell it comes from rests on
  std::array<bool, 2> inside{};                  // all of it is inside the body
  std::optional<HalfSpace> cut;                  // where to split it
  std::uint32_t node = 0;  // of the record
};

// Called with a point whose distance from all triangles looks promising. Which body it is outside of: 0, 1, or -1.
using Consider = std::function<int(Vec3 p)>;

// Sets the bound of the cell, and where to split it if that is larger than `enough`. `bound`, `near`, `met`, `columns` and
// `inside` are those of the cell it comes from. best: points that are no deeper are not considered. record: why the bound
// holds is written there, if it is not null.
void bound_cell(const TwoBodies& bodies, const Mat3& axes, OpenCell& open, double best, double enough, const Consider& consider,
                ThicknessRecord* record, Budget& budget);

}  // namespace satcheck
