// Hulls that are boxes: primitives that are placed, meshes of boxes, and their parts.
#pragma once

#include <optional>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

struct BoxFrame {
  Mat3 rotation;      // from the frame of the box to that of the hull
  Vec3 centre, half;  // in the frame of the hull; half extents along the axes of the box
  double error = 0;   // the two differ by less; includes the rounding of the frame when it is placed
};

// The box with these corners, in any order. Empty if they are not those of a box within rounding.
std::optional<BoxFrame> find_box(std::vector<Vec3> corners);

}  // namespace satcheck
