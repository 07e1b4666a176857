// Oriented boxes at no cost: the box of a mesh in file coordinates, moved by the transform of the body.
//
// No box is fitted to the vertices. If the transform rotates the body, the box rotates with it. If not, the oriented
// box is the world box.
#pragma once

#include <array>

#include "convex/sat.hpp"

namespace satcheck {

struct OrientedBox {
  bool turned = false;  // not along the world's axes
  bool is_box = false;  // false: the transform shears, and the box proves nothing
  Vec3 centre;
  Vec3 axis[3];  // unit and perpendicular to rounding, or to kOrthogonality; of either handedness
  Vec3 half;     // half extents along them
};

// Contains every point within `pad` of the image of `box` under the affine 4x4 matrix, by rows; null: the identity.
OrientedBox carried_box(const Aabb& box, const std::array<double, 16>* matrix, double pad);

// The axis that separates two boxes: a face normal of A or B, or the product of an edge of each; feature none: no axis
// does. axis_a, axis_b: axes of the boxes; -1: none. tested: how many of the 15 axes.
struct SeparatingAxis {
  Feature feature = Feature::none;
  int axis_a = -1, axis_b = -1, tested = 15;
};

// Exchanging A and B exchanges their parts in the answer.
SeparatingAxis separating_axis(const OrientedBox& a, const OrientedBox& b);

}  // namespace satcheck
