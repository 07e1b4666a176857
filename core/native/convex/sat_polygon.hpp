// Planar SAT: convex polygons over their edge normals.
#pragma once

#include <vector>

#include "convex/narrow_phase.hpp"

namespace satcheck {

struct Vec2 {
  double x = 0, y = 0;
};

// The projection of a set onto an axis: a closed interval.
struct Projection {
  double min, max;
};

Projection project(const std::vector<Vec2>& points, Vec2 axis);

struct PolygonResult {
  Outcome outcome = Outcome::undecided;
  double penetration = 0;  // > 0: least overlap. < 0: the widest gap along an edge normal, a lower bound of the distance
  Vec2 normal;             // unit, from A to B; moving A by -penetration * normal separates
  int edge_a = -1, edge_b = -1;  // the edge with the deciding normal
};

// Convex polygons, counter-clockwise, at least 3 corners, not all on one line. The outcome is exact.
PolygonResult sat_polygons(const std::vector<Vec2>& a, const std::vector<Vec2>& b);

}  // namespace satcheck
