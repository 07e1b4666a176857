// Where to split a cell whose bound is too large.
#pragma once

#include <optional>
#include <vector>

#include "thickness/cell.hpp"
#include "thickness/two_bodies.hpp"

namespace satcheck {

// A mean of convex functions, which is larger at the corners of a cell than at the mean of the corners.
struct CellGap {
  struct Term {
    Column column;  // not a plane
    double weight;  // > 0
  };
  const TwoBodies& bodies;
  const Mat3& axes;
  const Cell& cell;
  std::vector<Term> terms;
  const std::vector<double>& shares;  // of the corners
  Vec3 mean;                          // of the corners
  Budget& budget;
};

// Across the axis, or at the plane of a patch, that explains the gap best; else along an edge of a patch. Nothing: none
// explains it, or it is less than `least`.
std::optional<HalfSpace> cut_at_gap(const CellGap& gap, double least);

// Towards a point outside of the body, from the nearest one of the patches that meet the cell. layer: what is left of
// the void on the side of the patch. Nothing where there are many patches or corners, or where the point is in that layer.
std::optional<HalfSpace> cut_off_void(const Cell& cell, const ConvexPatches& patches, const PatchList& met, Vec3 point,
                                      double layer, Budget& budget);

}  // namespace satcheck
