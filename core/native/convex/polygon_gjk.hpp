// GJK in the plane (E. Gilbert, D. Johnson, S. Keerthi, "A fast procedure for computing the distance between complex
// objects in three-dimensional space", 1988): a simplex of the Minkowski difference b - a goes towards the origin. It
// visits few corners, and leaves close decisions to the walk over all edges (polygon_difference.hpp).
#pragma once

#include "convex/convex_polygon.hpp"

namespace satcheck {

// A corner of the difference.
struct DifferenceCorner {
  Vec2 w;              // b - a
  std::uint32_t i, j;  // the corners of A and B
};

enum class PolygonFinding { open, apart, meet };

struct PolygonGjk {
  PolygonFinding finding = PolygonFinding::open;  // apart and meet are proven
  // The end of the search for the distance: the nearest corner, or the ends of the nearest edge. Not proven.
  DifferenceCorner simplex[2] = {};
  int count = 0;
};

// to_distance: goes on after the first proof that the polygons are apart.
PolygonGjk gjk(const ConvexPolygon& a, const ConvexPolygon& b, bool to_distance);

}  // namespace satcheck
