// The verdict on two convex hulls, decided on the float64 coordinates by exact signs.
#pragma once

#include "narrow_phase.hpp"

namespace satcheck {

// Points are world coordinates; the bodies are their convex hulls. `slack` bounds the rounding error
// of a float64 support value: only axes within it of separating are tested exactly, all others
// are known to overlap. Never undecided.
//
// separated: an axis with a gap. touching: an axis without overlap, and a common point.
// penetrating: no facet normal of the Minkowski difference separates even weakly.
Outcome decide_exactly(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double slack);

}  // namespace satcheck
