// The penetration depth of two convex hulls: rounded from its exact value, and compared with a length.
#pragma once

#include "convex/exact_difference.hpp"

namespace satcheck {

// A and B must have a common interior.
ExactFigure exact_depth(const ExactDifference& difference);

// The sign of depth - length, length >= 0, for hulls of any dimension. The depth is 0 if the hulls touch, and negative if
// they are apart.
int compare_depth(const ExactDifference& difference, const Dyadic& length);

}  // namespace satcheck
