// Translations that put a corner of one triangle into the plane of another: where a way out along the normal of a
// face ends, and where bodies fit between each other without play.
#pragma once

#include <vector>

#include "base/vec.hpp"
#include "exact/triangle_pair.hpp"

namespace satcheck {

// All translations t of p's body with normal . t = height, `normal` unit.
struct CornerPlane {
  double height;
  int axis;  // along which the normal is, or -1
  Vec3 normal;

  double distance(Vec3 t) const;
  // The nearest of them to t; along an axis the other coordinates stay as they are.
  Vec3 nearest_to(Vec3 t) const;
};

// Of p moved against q: each corner of q in the plane of p, then each corner of p in the plane of q. A triangle without
// area has no plane.
std::vector<CornerPlane> corner_planes(const Corners& p, const Corners& q);

}  // namespace satcheck
