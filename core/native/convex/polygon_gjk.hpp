// GJK in the plane (E. Gilbert, D. Johnson, S. Keerthi, "A fast procedure for computing the distance between complex
// objects in three-dimensional space", 1988): a simplex of the Minkowski difference b - a goes towards the origin. It
// visits few corners, and leaves close decisions to the walk over all edges (polygon_difference.hpp).
#pragma once

#include "base/rounding.hpp"
#include "convex/convex_polygon.hpp"

namespace satcheck {

// A corner of the difference.
struct DifferenceCorner {
  Vec2 w;              // b - a
  std::uint32_t i, j;  // the corners of A and B
};

inline bool same(const DifferenceCorner& p, const DifferenceCorner& q) { return p.i == q.i && p.j == q.j; }

// The corner farthest against a direction.
inline DifferenceCorner difference_support(const ConvexPolygon& a, const ConvexPolygon& b, Vec2 direction) {
  const std::uint32_t i = a.support(direction), j = b.support(-direction);
  return {b.corners[j] - a.corners[i], i, j};
}

// The error of a support value d . w, as a share of |d| |w|: the supports of both, and five roundings of w and of the
// product. It also covers a product w x w'.
inline constexpr double kDifferenceNoise = (2 * kSupportRoundoffs + 8) * kUnitRoundoff;

struct OriginNearest {
  Vec2 v;
  double squared;  // |v|^2
  bool inner;      // not an end
};

// The point of the segment from p to q that is nearest to the origin.
OriginNearest nearest_to_origin(Vec2 p, Vec2 q);

enum class PolygonFinding { open, apart, meet };

struct PolygonGjk {
  PolygonFinding finding = PolygonFinding::open;  // apart and meet are proven
  // meet: a triangle around the origin. Otherwise the end of the search for the distance: the nearest corner, or the
  // ends of the nearest edge, not proven.
  DifferenceCorner simplex[3] = {};
  int count = 0;
};

// towards: from A to B, not 0; the search starts with the corner that is farthest against it. to_distance: goes on after
// the first proof that the polygons are apart.
PolygonGjk gjk(const ConvexPolygon& a, const ConvexPolygon& b, Vec2 towards, bool to_distance);

inline double size_of(const ConvexPolygon& p) { return (p.high.x - p.low.x) + (p.high.y - p.low.y); }

}  // namespace satcheck
