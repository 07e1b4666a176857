// The distance of two separated convex hulls, rounded from its exact value.
#pragma once

#include "convex/exact_difference.hpp"

namespace satcheck {

// A and B must have no common point.
ExactFigure exact_distance(const ExactDifference& difference);

}  // namespace satcheck
