// The convex hull of points.
#pragma once

#include "convex/polytope.hpp"

namespace satcheck {

// The convex hull of a set of points, with exact visibility tests: every input point lies inside
// or on the result, exactly. Throws std::invalid_argument on an empty or non-finite input.
//
// Method: C. Bradford Barber, David P. Dobkin, Hannu Huhdanpaa, "The Quickhull Algorithm for
// Convex Hulls" (1996), with exact orientation signs instead of its thickness tolerance.
Polytope convex_hull(const std::vector<Vec3>& points);

}  // namespace satcheck
