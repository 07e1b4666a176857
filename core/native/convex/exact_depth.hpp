// The penetration depth of two convex hulls, rounded from its exact value.
#pragma once

#include "convex/exact_difference.hpp"

namespace satcheck {

// A and B must have a common interior.
ExactFigure exact_depth(const ExactDifference& difference);

// The sign of depth - length, for the same depth.
int compare_depth(const ExactDifference& difference, const Dyadic& length);

}  // namespace satcheck
