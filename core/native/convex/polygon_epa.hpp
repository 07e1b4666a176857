// EPA in the plane (G. van den Bergen, "Proximity Queries and Penetration Depth Computation on 3D Game Objects", 2001):
// a polygon within the Minkowski difference grows at its edge that is nearest to the origin, until that edge is one of
// the difference.
#pragma once

#include "convex/polygon_gjk.hpp"

namespace satcheck {

struct PolygonEpa {
  bool closed = false;     // the rest is set
  DifferenceCorner p, q;   // the ends of the nearest edge, which may consist of two on one line
  double least = 0;        // a lower bound of the depth
};

// found: the triangle of two polygons that meet. Not closed after many steps, as for many edges of nearly one distance.
PolygonEpa epa(const ConvexPolygon& a, const ConvexPolygon& b, const PolygonGjk& found);

}  // namespace satcheck
