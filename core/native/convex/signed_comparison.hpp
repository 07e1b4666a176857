// Is the signed distance of two convex shapes smaller than, equal to, or larger than a length? Decided exactly.
#pragma once

#include <optional>

#include "convex/shape.hpp"

namespace satcheck {

// Sign of (signed distance - length), where a gap counts > 0 and a penetration < 0. Polytopes are taken at the
// vertices that their poses round to, spheres and capsules at such centres and axes. Nothing for other curved shapes.
std::optional<int> compare_signed_distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                                           double length);

}  // namespace satcheck
