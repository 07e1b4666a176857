// Oriented boxes for free: the box of a mesh in its file, carried by the transform of the body.
//
// No box is fitted to the vertices. Where a transform turns a body, its file box turns with it; where it does not,
// the oriented box is the world box.
#pragma once

#include <array>

#include "convex/sat.hpp"

namespace satcheck {

struct OrientedBox {
  bool turned = false;  // not along the world's axes
  bool is_box = false;  // false where the transform shears: no more is known then
  Vec3 centre;
  Vec3 axis[3];  // unit and perpendicular to rounding, or to kOrthogonality; of either handedness
  Vec3 half;     // half extents along them
};

// Holds every point within `pad` of the image of `box` under the affine 4x4 matrix, by rows; null: the identity.
OrientedBox carried_box(const Aabb& box, const std::array<double, 16>* matrix, double pad);

// What carries the axis that proves two boxes apart: face_a, face_b or edge_edge; none where no axis does. The
// same for B against A, faces exchanged.
Feature separating_feature(const OrientedBox& a, const OrientedBox& b);

}  // namespace satcheck
