// The last digits of the axis of a curved pair.
#pragma once

#include "convex/minkowski.hpp"

namespace satcheck {

struct AxisSupport {
  Vec3 axis;           // unit, A to B, frame of A
  SupportPoint point;  // the point of A - B farthest along it
  double value;        // axis . point.w: an upper bound of the signed penetration, whatever the axis
};

// The least support value of A - B near `axis`, which is unit. Never larger than the value along
// `axis` itself. Flat faces and mantle lines, where the support function has a crease, are tried.
AxisSupport least_support_near(const MinkowskiDifference& difference, Vec3 axis);

}  // namespace satcheck
