// Exact signs of determinants of float64 coordinates, and whether a point lies in a triangle.
//
// Method: Jonathan R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
// Geometric Predicates" (1997). A float64 filter with a static bound decides the generic case;
// otherwise the determinant is expanded without rounding, for the sign alone.
//
// Range: exact for coordinates of up to 1e45 (numeric_range.hpp), which all callers enforce. Coordinates may be small:
// if a product may underflow, neither the filter nor the expansions are used.
//
// budget: pays for exact arithmetic; what float64 can tell costs nothing.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "base/budget.hpp"
#include "base/rounding.hpp"
#include "base/vec.hpp"
#include "exact/double_double.hpp"

namespace satcheck {

// Sign (-1, 0, +1) of det[b - a; c - a; d - a]: +1 when d lies on the side of the plane of the
// triangle a, b, c to which its counter-clockwise normal (b - a) x (c - a) points.
int orientation(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Budget* budget = nullptr);

// The relative error of a 3x3 determinant in float64, as a share of the sum of the magnitudes of its terms. A term has
// at most 3 rounded differences, 2 products and 3 additions: |error| <= ((1 + u)^8 - 1) * permanent. The ninth u
// covers the roundings of the permanent and of the bound.
inline constexpr double kDeterminantBound = 9 * kUnitRoundoff;

// The error that underflow can add. The error of a product is half of the smallest float64, 2.5e-324, and it is
// multiplied by a difference of at most 2e45. For a dozen products, rounded up.
inline constexpr double kUnderflow = 1e-270;

// The plane of a triangle, for the sides of many points: side(d) == orientation(a, b, c, d).
class TrianglePlane {
 public:
  TrianglePlane(Vec3 a, Vec3 b, Vec3 c) : a(a), b(b), c(c) {
    const Vec3 u = b - a, v = c - a;
    const double yz = u.y * v.z, zy = u.z * v.y;
    const double zx = u.z * v.x, xz = u.x * v.z;
    const double xy = u.x * v.y, yx = u.y * v.x;
    normal_ = {yz - zy, zx - xz, xy - yx};
    permanent_ = {std::fabs(yz) + std::fabs(zy), std::fabs(zx) + std::fabs(xz), std::fabs(xy) + std::fabs(yx)};
  }

  int side(Vec3 d, Budget* budget = nullptr) const {
    // The same roundings as in determinant_sign(), with the rows in another order.
    const Vec3 w = d - a;
    const double determinant = dot(normal_, w);
    const double bound = kDeterminantBound * dot(permanent_, {std::fabs(w.x), std::fabs(w.y), std::fabs(w.z)}) + kUnderflow;
    if (determinant > bound) return 1;
    if (determinant < -bound) return -1;
    return orientation(a, b, c, d, budget);
  }

  Vec3 a, b, c;

 private:
  Vec3 normal_;     // (b - a) x (c - a) in float64
  Vec3 permanent_;  // the same with the magnitudes of its products added
};

// Sign of det[q1 - p1; q2 - p2; q3 - p3], rows being differences of the given points.
// orientation(a, b, c, d) == determinant_sign(a, b, a, c, a, d).
int determinant_sign(Vec3 p1, Vec3 q1, Vec3 p2, Vec3 q2, Vec3 p3, Vec3 q3, Budget* budget = nullptr);

// Sign of the z, x or y component (drop_axis 2, 0, 1) of (b - a) x (c - a): the orientation of the
// triangle projected along the named axis.
int orientation_2d(Vec3 a, Vec3 b, Vec3 c, int drop_axis, Budget* budget = nullptr);

// As kDeterminantBound: 2 differences, 1 product, 1 addition; the fifth u covers the bound's own roundings.
inline constexpr double kOrientation2dBound = 5 * kUnitRoundoff;

// turn_sign() where float64 does not tell it.
int exact_turn_sign(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

// Sign of (b - a) x (d - c): +1 if the second direction is to the left of the first.
inline int turn_sign(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const Vec2 u = b - a, v = d - c;
  const double left = u.x * v.y, right = u.y * v.x;
  const double bound = kOrientation2dBound * (std::fabs(left) + std::fabs(right)) + kUnderflow;
  if (left - right > bound) return 1;
  if (left - right < -bound) return -1;
  if ((u.x == 0 || v.y == 0) && (u.y == 0 || v.x == 0)) return 0;
  return exact_turn_sign(a, b, c, d);
}

// The orientation in the plane: +1 if c lies to the left of the line from a to b.
inline int orientation(Vec2 a, Vec2 b, Vec2 c) { return turn_sign(a, b, a, c); }

// Whether the three points lie on one line (or coincide).
bool collinear(Vec3 a, Vec3 b, Vec3 c, Budget* budget = nullptr);

// (b - a) x (c - a) with a relative error below 1e-14 of its length, even for thin triangles; zero exactly if the
// points are collinear.
Vec3 rounded_normal(Vec3 a, Vec3 b, Vec3 c, Budget* budget = nullptr);

// a.x b.x + a.y b.y + a.z b.z + offset, summed in twice the precision and rounded once.
double rounded_affine(Vec3 a, Vec3 b, double offset);

// The same for many points, in place: x, y and z of each by the three rows.
void round_affine(const Vec3 (&row)[3], Vec3 offset, std::vector<Vec3>& points);

// The same for a sum of up to 2^32 determinants.
inline constexpr double kManyUnderflows = 1e-260;

// Signed volume enclosed by a closed, consistently wound surface, positive when wound outwards.
// Rounded, but its sign is exact: 0.0 only when the volume is exactly 0.
double signed_volume(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);

// The same sum, triangle by triangle, for callers that do more in the same pass. origin: the first corner of the first
// triangle.
class VolumeSum {
 public:
  explicit VolumeSum(Vec3 origin) : origin_(origin) {}

  void add(Vec3 corner_a, Vec3 corner_b, Vec3 corner_c) {
    const Vec3 a = corner_a - origin_, b = corner_b - origin_, c = corner_c - origin_;
    const DoubleDouble s = exact_sum(total_, dot(a, cross(b, c)));
    total_ = s.high;
    correction_ += s.low;
    const Vec3 size_b{std::fabs(b.x), std::fabs(b.y), std::fabs(b.z)};
    const Vec3 size_c{std::fabs(c.x), std::fabs(c.y), std::fabs(c.z)};
    permanent_ += std::fabs(a.x) * (size_b.y * size_c.z + size_b.z * size_c.y) +
                  std::fabs(a.y) * (size_b.z * size_c.x + size_b.x * size_c.z) +
                  std::fabs(a.z) * (size_b.x * size_c.y + size_b.y * size_c.x);
  }

  // Empty if the sign of the sum is not certain.
  std::optional<double> volume() const {
    const double six_volumes = total_ + correction_;
    // The determinants' own bound, and as much again for the compensated sum of up to 2^32 terms.
    if (!(std::fabs(six_volumes) > 2 * kDeterminantBound * permanent_ + kManyUnderflows)) return std::nullopt;
    return six_volumes / 6;
  }

 private:
  Vec3 origin_;
  double total_ = 0, correction_ = 0, permanent_ = 0;
};

// The points, by number, in counter-clockwise order about the direction from p to q. Those in one half-plane that ends at
// the line form a group. No point should be on the line.
std::vector<std::vector<std::size_t>> groups_around(Vec3 p, Vec3 q, const std::vector<Vec3>& points, Budget* budget = nullptr);

// Points in the plane of a triangle. The same functions for rounded and exact points.
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

// An axis along which a projection does not flatten the triangle, unless it is collinear. This costs less than the normal
// of a thin triangle.
int projection_axis(Vec3 a, Vec3 b, Vec3 c, Budget* budget = nullptr);

// Whether a point lies in the closed triangle. It has to be in its plane, and the triangle must not be collinear.
template <class Point>
bool plane_point_in_triangle(const Point& p, Vec3 a, Vec3 b, Vec3 c, Budget* budget = nullptr) {
  const int axis = projection_axis(a, b, c, budget);
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
