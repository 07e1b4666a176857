// Clipping: I. E. Sutherland, G. W. Hodgman, "Reentrant Polygon Clipping" (1974), applied to the two support features,
// seen along the axis. Let the axis be the normal of a facet of the Minkowski difference that contains the projection
// of the origin. The features then have a common region in exact arithmetic.

#include "convex/contact_region.hpp"

#include <algorithm>
#include <vector>

#include "base/rounding.hpp"

namespace satcheck {

namespace {

using Polygon = std::vector<Vec2>;  // counter-clockwise; two points: a segment; one: a point

// A. M. Andrew's monotone chain (1979).
Polygon hull_2d(Polygon points) {
  std::sort(points.begin(), points.end(), [](Vec2 p, Vec2 q) { return p.x < q.x || (p.x == q.x && p.y < q.y); });
  if (points.size() < 3) return points;
  Polygon hull;
  hull.reserve(points.size() + 1);
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (Vec2 p : points) {
      while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

struct Plane2 {
  Vec3 u, v;
  Vec2 project(Vec3 p) const { return {dot(p, u), dot(p, v)}; }
};

Plane2 plane_across(Vec3 axis) {
  const Vec3 u = any_perpendicular(axis);
  return {u, cross(axis, u)};
}

Polygon support_feature(const Shape& shape, const Pose& pose, Vec3 axis, const Plane2& plane, double tolerance) {
  double top = -INFINITY;
  for (Vec3 p : shape.polytope.vertices) top = std::fmax(top, dot(axis, pose * p));
  Polygon feature;
  for (Vec3 p : shape.polytope.vertices) {
    const Vec3 placed = pose * p;
    if (dot(axis, placed) >= top - tolerance) feature.push_back(plane.project(placed));
  }
  return hull_2d(std::move(feature));
}

Polygon clip(Polygon subject, const Polygon& window) {
  for (std::size_t i = 0; i < window.size() && !subject.empty(); ++i) {
    const Vec2 from = window[i], along = window[(i + 1) % window.size()] - from;
    Polygon kept;
    const std::size_t count = subject.size();
    kept.reserve(count + 1);
    for (std::size_t k = 0; k < count; ++k) {
      const Vec2 p = subject[k], q = subject[(k + 1) % count];
      const double dp = cross(along, p - from), dq = cross(along, q - from);
      if (dp >= 0) kept.push_back(p);
      if (count > 1 && ((dp > 0 && dq < 0) || (dp < 0 && dq > 0))) {
        const double t = dp / (dp - dq);
        kept.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
      }
    }
    subject = std::move(kept);
  }
  return subject;
}

Vec2 closest_on_segment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 e = b - a;
  const double length_squared = dot(e, e);
  const double t = length_squared > 0 ? std::clamp(dot(p - a, e) / length_squared, 0.0, 1.0) : 0.0;
  return {a.x + t * e.x, a.y + t * e.y};
}

// The point where two segments cross or are closest. For collinear segments, the middle of their overlap.
Vec2 crossing(const Polygon& s, const Polygon& t) {
  const Vec2 d = s[1] - s[0], e = t[1] - t[0];
  const double area = cross(d, e);
  if (area * area > kParallelSquared * dot(d, d) * dot(e, e)) {
    const double along = std::clamp(cross(t[0] - s[0], e) / area, 0.0, 1.0);
    return {s[0].x + along * d.x, s[0].y + along * d.y};
  }
  const Vec2 p = closest_on_segment(t[0], s[0], s[1]), q = closest_on_segment(t[1], s[0], s[1]);
  return {(p.x + q.x) / 2, (p.y + q.y) / 2};
}

Vec2 middle(const Polygon& polygon) {
  Vec2 sum{0, 0};
  for (Vec2 p : polygon) sum = {sum.x + p.x, sum.y + p.y};
  const double count = static_cast<double>(polygon.size());
  return {sum.x / count, sum.y / count};
}

Vec2 common_point(const Polygon& a, const Polygon& b) {
  if (a.size() == 1) return a[0];
  if (b.size() == 1) return b[0];
  if (a.size() == 2 && b.size() == 2) return crossing(a, b);
  const Polygon common = a.size() >= 3 ? clip(b, a) : clip(a, b);
  if (!common.empty()) return middle(common);
  // Features that meet in a single point may miss each other by rounding. The nearest corner is then that point.
  const Polygon& window = a.size() >= 3 ? a : b;
  const Polygon& other = a.size() >= 3 ? b : a;
  Vec2 best = other[0];
  double nearest = INFINITY;
  for (Vec2 p : other) {
    for (std::size_t i = 0; i < window.size(); ++i) {
      const Vec2 foot = closest_on_segment(p, window[i], window[(i + 1) % window.size()]);
      if (dot(p - foot, p - foot) < nearest) {
        nearest = dot(p - foot, p - foot);
        best = foot;
      }
    }
  }
  return best;
}

}  // namespace

Witnesses contact_region_centre(const MinkowskiDifference& m, Vec3 axis, double penetration) {
  const Plane2 plane = plane_across(axis);
  const double tolerance = kSameFeature * m.scale;
  const Polygon a = support_feature(m.a, {}, axis, plane, tolerance);
  const Polygon b = support_feature(m.b, m.b_in_a, -axis, plane, tolerance);
  const Vec2 p = common_point(a, b);
  double top = -INFINITY;
  for (Vec3 v : m.a.polytope.vertices) top = std::fmax(top, dot(axis, v));
  const Vec3 on_a = plane.u * p.x + plane.v * p.y + axis * top;
  return {on_a, on_a - axis * penetration};
}

}  // namespace satcheck
