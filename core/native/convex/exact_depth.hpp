// The penetration depth of two convex hulls: rounded from its exact value, and compared with a length. The same comparison
// for their signed distance.
#pragma once

#include <optional>

#include "convex/exact_distance.hpp"
#include "convex/shape.hpp"

namespace satcheck {

// The most steps that exact arithmetic may take for a pair, about half a second. Regular prisms of thousands of sides,
// one in the middle of the other, have as many nearest faces, and would take minutes.
inline constexpr std::uint64_t kMostExactWork = 500'000'000;

// A and B must have a common interior.
ExactFigure exact_depth(const ExactDifference& difference);

// The sign of depth - length, length >= 0, for hulls of any dimension. The depth is 0 if the hulls touch, and negative if
// they are apart.
int compare_depth(const ExactDifference& difference, const Dyadic& length);

// Sign of (signed distance - length); a gap is > 0, a penetration < 0. The answer holds for the rounded world
// coordinates of vertices, centres and axes. Empty for other curved shapes, and if it takes too many steps.
std::optional<int> compare_signed_distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                                           double length);

}  // namespace satcheck
