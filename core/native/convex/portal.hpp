// Do two convex shapes overlap? From their support functions, with a proof either way.
#pragma once

#include "convex/minkowski.hpp"

namespace satcheck {

enum class PortalFinding {
  apart,     // an axis separates by more than `noise`
  overlaps,  // points of A - B hold the origin, deeper than `noise`
  open,      // neither is proven: they touch, or come close to it, or A - B is flat
};

struct PortalResult {
  PortalFinding finding = PortalFinding::open;
  int rounds = 0;  // of one support point each
};

// `noise` bounds what rounding does to a support value of the shapes as they are placed.
PortalResult seek_portal(const MinkowskiDifference& difference, double noise);

}  // namespace satcheck
