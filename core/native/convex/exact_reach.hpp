// Compares the distance of two convex hulls with a length, exactly.
#pragma once

#include "convex/polytope.hpp"
#include "exact/dyadic.hpp"

namespace satcheck {

// Sign of distance - length, for hulls of any dimension without a common point.
int compare_distance(const Polytope& a, const Polytope& b, const Dyadic& length);

}  // namespace satcheck
