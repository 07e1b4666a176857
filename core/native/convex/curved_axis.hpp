// The last digits of the axis of a curved pair.
#pragma once

#include "convex/minkowski.hpp"

namespace satcheck {

struct AxisSupport {
  Vec3 axis;           // unit, A to B, frame of A
  SupportPoint point;  // the point of A - B farthest along it
  double value;        // axis . point.w: for any axis an upper bound of the signed penetration
};

// The least support value of A - B near the unit vector `axis`. It is never larger than the value along `axis`. Normals
// of flat faces and mantle lines, where the support function has a crease, are tried too.
AxisSupport least_support_near(const MinkowskiDifference& difference, Vec3 axis);

}  // namespace satcheck
