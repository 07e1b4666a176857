// The distance of two convex hulls: rounded from its exact value, and compared with a length.
#pragma once

#include "convex/exact_difference.hpp"

namespace satcheck {

// A and B must have no common point.
ExactFigure exact_distance(const ExactDifference& difference);

// Sign of distance - length, for hulls of any dimension; the distance of hulls that meet is 0.
int compare_distance(const ExactDifference& difference, const Dyadic& length);

}  // namespace satcheck
