// Method: Christer Ericson, "Real-Time Collision Detection" (2005), 5.1.5 and 5.1.9: two disjoint triangles are nearest
// at a corner and a face or at two edges. Where we deviate: exact signs decide whether they meet. If edges are nearly
// parallel, the place of their nearest points cancels in float64, and is computed in twice the precision, because a
// corner may be much farther. All normals are computed in twice the precision, too.
#include "exact/triangle_distance.hpp"

#include <algorithm>

#include "exact/double_double.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

double clamp01(double x) { return x > 0 ? (x < 1 ? x : 1.0) : 0.0; }  // NaN becomes 0

Vec3 nearest_on_segment(Vec3 x, Vec3 p, Vec3 q) {
  const Vec3 d = q - p;
  return p + d * clamp01(dot(x - p, d) / dot(d, d));
}

// If sin^2 of the angle of two edges is below this, the error of the float64 place along them exceeds 1e-12 of their
// length. In twice the precision the error is 1e-16 down to angles of 1e-8. At an angle of 1e-12 the error is 1e-8, but
// moving that far along the edges changes their distance by only 1e-20 of the length.
constexpr double kNearlyParallelSquared = 1e-4;

struct WideVec {
  DoubleDouble x, y, z;
};

WideVec wide_difference(Vec3 a, Vec3 b) { return {exact_sum(a.x, -b.x), exact_sum(a.y, -b.y), exact_sum(a.z, -b.z)}; }

DoubleDouble dot(const WideVec& a, const WideVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// The place on the line of p1 q1 that is nearest to the line of p2 q2: 0 at p1 and 1 at q1. NaN for parallel lines.
double nearest_place(Vec3 p1, Vec3 q1, Vec3 p2, Vec3 q2) {
  const WideVec d1 = wide_difference(q1, p1), d2 = wide_difference(q2, p2), r = wide_difference(p1, p2);
  const DoubleDouble a = dot(d1, d1), e = dot(d2, d2), b = dot(d1, d2), c = dot(d1, r), f = dot(d2, r);
  return static_cast<double>(b * f - c * e) / static_cast<double>(a * e - b * b);
}

NearestPoints segment_distance(Vec3 p1, Vec3 q1, Vec3 p2, Vec3 q2) {
  const Vec3 d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
  const double a = dot(d1, d1), e = dot(d2, d2), b = dot(d1, d2), c = dot(d1, r), f = dot(d2, r);
  const double area_squared = a * e - b * b;
  const double s = clamp01(area_squared > kNearlyParallelSquared * a * e ? (b * f - c * e) / area_squared
                                                                         : nearest_place(p1, q1, p2, q2));
  const Vec3 on_2 = nearest_on_segment(p1 + d1 * s, p2, q2);
  const Vec3 on_1 = nearest_on_segment(on_2, p1, q1);
  return {on_1, on_2, norm_squared(on_2 - on_1)};
}

Vec3 nearest_on_boundary(Vec3 p, const Corners& t) {
  Vec3 best = nearest_on_segment(p, t[0], t[1]);
  for (int i = 1; i < 3; ++i) {
    const Vec3 candidate = nearest_on_segment(p, t[i], t[(i + 1) % 3]);
    if (norm_squared(candidate - p) < norm_squared(best - p)) best = candidate;
  }
  return best;
}

// normal: of the triangle, accurate to rounding even for thin triangles; 0 if it is collinear.
Vec3 nearest_on_triangle(Vec3 p, const Corners& t, Vec3 normal) {
  const double length_squared = norm_squared(normal);
  if (!(length_squared > 0)) return nearest_on_boundary(p, t);
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = t[(i + 1) % 3] - t[i], w = p - t[i];
    const double yz = e.y * w.z, zy = e.z * w.y, zx = e.z * w.x, xz = e.x * w.z, xy = e.x * w.y, yx = e.y * w.x;
    const double side = normal.x * (yz - zy) + normal.y * (zx - xz) + normal.z * (xy - yx);
    const double permanent = std::fabs(normal.x) * (std::fabs(yz) + std::fabs(zy)) + std::fabs(normal.y) * (std::fabs(zx) + std::fabs(xz)) +
                             std::fabs(normal.z) * (std::fabs(xy) + std::fabs(yx));
    // If rounding hides the side of an edge, the edge is as near as the inside.
    if (!(side > kDeterminantBound * permanent)) return nearest_on_boundary(p, t);
  }
  return p - normal * (dot(normal, p - t[0]) / length_squared);
}

// In twice the precision, because for a needle the cross product of two edges is mostly rounding noise.
Vec3 normal_of(const Corners& t) {
  const WideVec u = wide_difference(t[1], t[0]), v = wide_difference(t[2], t[0]);
  return {static_cast<double>(u.y * v.z - u.z * v.y), static_cast<double>(u.z * v.x - u.x * v.z),
          static_cast<double>(u.x * v.y - u.y * v.x)};
}

}  // namespace

Vec3 nearest_on_triangle(Vec3 p, const Corners& t) { return nearest_on_triangle(p, t, normal_of(t)); }

NearestPoints triangle_distance(const Corners& a, const Corners& b, Budget* budget) {
  if (meet(bounds_of(a), bounds_of(b))) {
    const TriangleContact contact = classify(a, b, budget);
    if (contact != TriangleContact::disjoint) {
      const Vec3 p = contact == TriangleContact::crossing ? crossing_point(a, b) : contact_point(a, b);
      return {p, p, 0};
    }
  }
  NearestPoints best{a[0], b[0], INFINITY};
  const auto consider = [&](const NearestPoints& w) {
    if (w.distance_squared < best.distance_squared) best = w;
  };
  const Vec3 normal_a = normal_of(a), normal_b = normal_of(b);
  for (int i = 0; i < 3; ++i) {
    const Vec3 on_b = nearest_on_triangle(a[i], b, normal_b), on_a = nearest_on_triangle(b[i], a, normal_a);
    consider({a[i], on_b, norm_squared(on_b - a[i])});
    consider({on_a, b[i], norm_squared(on_a - b[i])});
    for (int k = 0; k < 3; ++k) {
      consider(segment_distance(a[i], a[(i + 1) % 3], b[k], b[(k + 1) % 3]));
    }
  }
  return best;
}

}  // namespace satcheck
