// Translations that put a corner of one triangle into the plane of another. A way out along the normal of a face ends
// at such a translation, and so does a position in which a body fits without clearance.
#pragma once

#include <vector>

#include "base/vec.hpp"
#include "exact/triangle_pair.hpp"

namespace satcheck {

// All translations t of p's body with normal . t = height, `normal` unit.
struct CornerPlane {
  double height;
  int axis;  // axis of the normal, or -1
  Vec3 normal;

  double distance(Vec3 t) const;
  // The nearest of these translations to t. If the normal is along an axis, the other coordinates do not change.
  Vec3 nearest_to(Vec3 t) const;
};

// The planes for p, moved relative to q: each corner of q in the plane of p, then each corner of p in the plane of q. A
// triangle without area has no plane.
std::vector<CornerPlane> corner_planes(const Corners& p, const Corners& q);

}  // namespace satcheck
