// The penetration depth of two convex hulls, rounded from its exact value.
#pragma once

#include "convex/exact_difference.hpp"

namespace satcheck {

// A and B must have a common interior.
ExactFigure exact_depth(const ExactDifference& difference);

// Sign of the depth - length, of the same.
int compare_depth(const ExactDifference& difference, const Dyadic& length);

}  // namespace satcheck
