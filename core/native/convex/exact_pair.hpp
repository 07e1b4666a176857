// The verdict on two convex hulls, decided on the float64 coordinates by exact signs.
#pragma once

#include "convex/narrow_phase.hpp"

namespace satcheck {

// Both are exact hulls in world coordinates. `slack` bounds the rounding error of a float64 support value. Only axes
// within `slack` of separating are tested exactly; along all others the hulls overlap. Never undecided.
//
// touching: a common point, and a plane that separates the hulls weakly. penetrating: a common point and no such plane,
// or one hull inside the other. separated: no common point.
Outcome decide_exactly(Polytope a, Polytope b, double slack);

}  // namespace satcheck
