// Decides by support functions whether two convex shapes overlap, with a proof for either answer.
#pragma once

#include "convex/minkowski.hpp"

namespace satcheck {

enum class PortalFinding {
  apart,     // an axis separates by more than `noise`
  overlaps,  // points of A - B contain the origin, deeper than `noise`
  open,      // nothing is proven: they touch or almost touch, or A - B is flat
};

struct PortalResult {
  PortalFinding finding = PortalFinding::open;
  int rounds = 0;  // of one support point each
  Vec3 axis;       // the last direction, from A to B, frame of A, of any length
};

// `noise`: a bound of the rounding error of a support value of the placed shapes.
PortalResult seek_portal(const MinkowskiDifference& difference, double noise);

}  // namespace satcheck
