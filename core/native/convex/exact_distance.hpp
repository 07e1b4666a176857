// The distance of two separated convex hulls: rounded from its exact value, and compared with a length.
#pragma once

#include "convex/exact_difference.hpp"

namespace satcheck {

// A and B must have no common point.
ExactFigure exact_distance(const ExactDifference& difference);

// Sign of distance - length. A and B, hulls of any dimension, must have no common point.
int compare_distance(const ExactDifference& difference, const Dyadic& length);

}  // namespace satcheck
