// Distances between points, segments and triangles in float64, with witness points.
#pragma once

#include "exact/triangle_pair.hpp"

namespace satcheck {

// The point of a closed triangle nearest to p. The triangle may be degenerate.
Vec3 nearest_on_triangle(Vec3 p, const Corners& t);

struct NearestPoints {
  Vec3 a, b;
  double distance_squared;
};

// Nearest points of two closed triangles. Exactly 0 apart when they have a common point.
NearestPoints triangle_distance(const Corners& a, const Corners& b, Budget* budget = nullptr);

// A lower bound of the squared distance of points in the two boxes, exact up to rounding.
inline double box_distance_squared(const Aabb& a, const Aabb& b) {
  const auto gap = [](double min_a, double max_a, double min_b, double max_b) {
    const double g = min_b > max_a ? min_b - max_a : min_a > max_b ? min_a - max_b : 0.0;
    return g * g;
  };
  return gap(a.min.x, a.max.x, b.min.x, b.max.x) + gap(a.min.y, a.max.y, b.min.y, b.max.y) +
         gap(a.min.z, a.max.z, b.min.z, b.max.z);
}

}  // namespace satcheck
