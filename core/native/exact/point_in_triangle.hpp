// Points in the plane of a triangle. The same functions for rounded and exact points.
#pragma once

#include <cmath>

#include "exact/predicates.hpp"

namespace satcheck {

inline int orientation_2d_at(Vec3 a, Vec3 b, Vec3 p, int drop_axis, Budget* budget = nullptr) {
  return orientation_2d(a, b, p, drop_axis, budget);
}
inline Aabb point_box(Vec3 p) { return {p, p}; }
inline Vec3 rounded_point(Vec3 p) { return p; }

// The axis along which a triangle with a normal of rounded components is widest.
inline int projection_axis(Vec3 normal) {
  const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

// Whether a point lies in the closed triangle. It has to be in its plane, and the triangle must not be collinear.
template <class Point>
bool plane_point_in_triangle(const Point& p, Vec3 a, Vec3 b, Vec3 c, Budget* budget = nullptr) {
  const int axis = projection_axis(rounded_normal(a, b, c, budget));
  const int ab = orientation_2d_at(a, b, p, axis, budget);
  const int bc = orientation_2d_at(b, c, p, axis, budget);
  const int ca = orientation_2d_at(c, a, p, axis, budget);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

// Whether p is in the closed triangle. Collinear triangles contain no point here, because in a closed mesh their edges
// also belong to other triangles.
template <class Point>
bool point_in_triangle(const Point& p, Vec3 a, Vec3 b, Vec3 c, Budget* budget = nullptr) {
  return orientation(a, b, c, p, budget) == 0 && !collinear(a, b, c, budget) && plane_point_in_triangle(p, a, b, c, budget);
}

}  // namespace satcheck
