// Compares the signed distance of two convex shapes with a length, exactly.
#pragma once

#include <optional>

#include "convex/shape.hpp"

namespace satcheck {

// Sign of (signed distance - length); a gap is > 0, a penetration < 0. The answer holds for the rounded world
// coordinates of vertices, centres and axes. Empty for other curved shapes.
std::optional<int> compare_signed_distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                                           double length);

}  // namespace satcheck
