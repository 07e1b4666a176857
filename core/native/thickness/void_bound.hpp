// The depth in a cell around a void of one of the bodies: thin shells between walls that fit.
#pragma once

#include "thickness/cell.hpp"
#include "thickness/two_bodies.hpp"

namespace satcheck {

// The void is where the cell is on the same side as `hollow` of the planes of all patches of the body that meet it. None
// of them has a point in it, so it is outside of the body as that point is. What is left of the cell lies beyond one of
// the planes: no point of it is farther from that plane than the other body reaches beyond it.
struct CellVoid {
  const Cell& cell;
  int body;
  const PatchList& met;   // patches of the body that may have a point in the interior of the cell
  Vec3 hollow;            // a point of the cell outside of the body
  // Of the other body: all that are no farther from the cell than its bound, and others; nullptr: not listed.
  const PatchList* near;
};

// No point of the cell is deeper in both, rounding included; INFINITY where that would not be less than `enough`, which
// is no larger than the bound of the cell.
double bound_around(const CellVoid& hollow, const TwoBodies& bodies, double enough, Budget& budget);

}  // namespace satcheck
