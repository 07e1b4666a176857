// Points with rational coordinates, for samples that are not float64 points.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <utility>

#include "base/budget.hpp"
#include "base/vec.hpp"
#include "exact/dyadic.hpp"

namespace satcheck {

// The point (x, y, z) / w, w > 0, and its rounding.
struct ExactPoint {
  Dyadic x, y, z, w;
  Vec3 rounded;
  Vec3 error;  // |rounded - exact| per coordinate
};

// Measured steps of an exact sign with this point: more for longer numbers.
std::uint64_t sign_work(const ExactPoint& p);

ExactPoint make_exact_point(Vec3 p);
ExactPoint make_exact_point(Dyadic x, Dyadic y, Dyadic z, Dyadic w);

// (wa a + wb b + wc c) / (wa + wb + wc), weights of one sign, not all zero.
ExactPoint weighted_point(Vec3 a, Vec3 b, Vec3 c, const Dyadic& wa, const Dyadic& wb, const Dyadic& wc);

// (wp p + wq q) / (wp + wq), weights of one sign, not both zero.
ExactPoint between(const ExactPoint& p, const ExactPoint& q, const Dyadic& wp, const Dyadic& wq);

// The determinant whose sign is orientation(a, b, c, d).
Dyadic orientation_value(Vec3 a, Vec3 b, Vec3 c, Vec3 d);
// The same times d.w.
Dyadic orientation_value(Vec3 a, Vec3 b, Vec3 c, const ExactPoint& d);

// The point where the line through p and q meets the plane of a, b, c. p and q are on different sides; one may lie in
// the plane.
ExactPoint plane_meeting_point(Vec3 a, Vec3 b, Vec3 c, Vec3 p, Vec3 q);

// Where the segment p q meets the line through u and v in their common plane. p and q are on different sides of it.
ExactPoint crossing_point(const ExactPoint& p, const ExactPoint& q, const ExactPoint& u, const ExactPoint& v, int drop_axis);

// A point in float64 with an `error` for each coordinate. It is computed exactly only for signs that float64 does not
// decide.
class LazyPoint {
 public:
  LazyPoint(Vec3 rounded, Vec3 error, std::function<ExactPoint()> make)
      : rounded(rounded), error(error), make_(std::move(make)) {}

  const ExactPoint& exact() const {
    if (!exact_) exact_ = std::make_shared<const ExactPoint>(make_());
    return *exact_;
  }

  Vec3 rounded, error;

 private:
  std::function<ExactPoint()> make_;
  mutable std::shared_ptr<const ExactPoint> exact_;  // long: most points never need it
};

// Lazy versions of the functions above. The arguments must outlive the point.
LazyPoint lazy_centroid(const std::array<Vec3, 3>& triangle);
LazyPoint lazy_centroid(std::array<Vec3, 3>&& triangle) = delete;  // it has to live as long as the point
LazyPoint lazy_meeting_point(const std::array<Vec3, 3>& plane, const Vec3& p, const Vec3& q);
LazyPoint lazy_between(const LazyPoint& p, const LazyPoint& q, double wp, double wq);
// Lazy versions for points that do not stay where they are: make() returns the exact point.
LazyPoint lazy_meeting_point(const std::array<Vec3, 3>& plane, Vec3 p, Vec3 q, std::function<ExactPoint()> make);
LazyPoint lazy_crossing(const LazyPoint& p, const LazyPoint& q, const LazyPoint& u, const LazyPoint& v, int drop_axis,
                        std::function<ExactPoint()> make);

bool operator==(const ExactPoint& p, const ExactPoint& q);

// The predicates of predicates.hpp with an exact point in the last place.
int orientation(Vec3 a, Vec3 b, Vec3 c, const ExactPoint& d, Budget* budget = nullptr);
int orientation(Vec3 a, Vec3 b, Vec3 c, const LazyPoint& d, Budget* budget = nullptr);
int orientation_2d_at(Vec3 a, Vec3 b, const ExactPoint& p, int drop_axis, Budget* budget = nullptr);
int orientation_2d_at(Vec3 a, Vec3 b, const LazyPoint& p, int drop_axis, Budget* budget = nullptr);
int orientation_2d_at(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int drop_axis, Budget* budget = nullptr);
int orientation_2d_at(const LazyPoint& a, const LazyPoint& b, const LazyPoint& c, int drop_axis, Budget* budget = nullptr);
// The sign of p[axis] - q[axis].
int compare_along(const LazyPoint& p, const LazyPoint& q, int axis, Budget* budget = nullptr);

// As point_in_triangle(). If float64 does not decide, most triangles miss the point when seen along an axis. This test
// comes first, because it needs fewer digits than the test of the plane.
bool point_in_triangle(const ExactPoint& p, Vec3 a, Vec3 b, Vec3 c, Budget* budget = nullptr);
bool point_in_triangle(const LazyPoint& p, Vec3 a, Vec3 b, Vec3 c, Budget* budget = nullptr);

// The value of that sign, times a positive factor that depends only on a and b, and times c.w.
Dyadic area_value(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int drop_axis);

inline const Dyadic& coordinate(const ExactPoint& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

// The two axes that remain when one is dropped, in the order that keeps the orientation.
struct PlaneAxes {
  int i, j;
};
inline PlaneAxes plane_axes(int drop_axis) {
  return {drop_axis == 2 ? 0 : drop_axis + 1, drop_axis == 0 ? 2 : drop_axis - 1};
}

inline Aabb point_box(const ExactPoint& p) { return {p.rounded - p.error, p.rounded + p.error}; }
inline Aabb point_box(const LazyPoint& p) { return {p.rounded - p.error, p.rounded + p.error}; }
inline Vec3 rounded_point(const ExactPoint& p) { return p.rounded; }
inline Vec3 rounded_point(const LazyPoint& p) { return p.rounded; }

}  // namespace satcheck
