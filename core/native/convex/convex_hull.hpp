// The convex hull of points.
#pragma once

#include "base/budget.hpp"
#include "convex/polytope.hpp"

namespace satcheck {

// The convex hull of a set of points, with exact visibility tests: every input point lies inside
// or on the result, exactly. Throws std::invalid_argument on an empty or non-finite input.
//
// Method: C. Bradford Barber, David P. Dobkin, Hannu Huhdanpaa, "The Quickhull Algorithm for
// Convex Hulls" (1996), with exact orientation signs instead of its thickness tolerance.
Polytope convex_hull(const std::vector<Vec3>& points, Budget* budget = nullptr);

// The same hull without faces and edges, which takes half the time. No triangle is degenerate, but neighbours may lie in
// one plane. None if all points do.
struct HullTriangles {
  std::vector<Vec3> points;         // distinct, by x, then y, then z
  std::vector<Triangle> triangles;  // outward, counter-clockwise
};
HullTriangles hull_triangles(const std::vector<Vec3>& points, Budget* budget = nullptr);

}  // namespace satcheck
