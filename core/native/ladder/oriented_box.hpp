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

// The feature whose axis separates two boxes: face_a, face_b or edge_edge; none if no axis does. Swapping A and B
// swaps face_a and face_b.
Feature separating_feature(const OrientedBox& a, const OrientedBox& b);

}  // namespace satcheck
