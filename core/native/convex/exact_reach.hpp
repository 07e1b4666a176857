// Is the distance of two convex hulls smaller than, equal to, or larger than a length? Decided exactly.
#pragma once

#include "convex/polytope.hpp"

namespace satcheck {

// The sum of two lengths, taken without rounding: the radii around two cores.
struct Reach {
  double a, b;
};

// Sign of distance - reach, for hulls of any dimension without a common point.
int compare_distance(const Polytope& a, const Polytope& b, Reach reach);

}  // namespace satcheck
