// Two convex polygons are disjoint exactly if an edge normal of one of them separates them. If they overlap, the least
// overlap is also along an edge normal, because every edge of the Minkowski difference is an edge of A or of -B (C.
// Ericson, "Real-Time Collision Detection", 2004, 5.2).

#include "convex/sat_polygon.hpp"

#include <algorithm>
#include <stdexcept>

#include "exact/predicates.hpp"

namespace satcheck {

namespace {

Vec3 lift(Vec2 p) { return {p.x, p.y, 0}; }

// +1 when p lies left of the edge from -> to, exactly.
int side_of(Vec2 from, Vec2 to, Vec2 p) { return orientation_2d(lift(from), lift(to), lift(p), 2); }

bool rises(Vec2 from, Vec2 to) { return to.x != from.x ? to.x > from.x : to.y > from.y; }

// Whether the edges turn round once in all. Those of a star turn left everywhere, too, but more than once.
bool goes_round_once(const std::vector<Vec2>& polygon) {
  int ends = 0, edges = 0;
  bool first = false, last = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 from = polygon[i], to = polygon[(i + 1) % polygon.size()];
    if (from.x == to.x && from.y == to.y) continue;
    const bool now = rises(from, to);
    if (edges++ == 0) first = last = now;
    ends += now != last;
    last = now;
  }
  return ends + (last != first) == 2;
}

void require_convex(const std::vector<Vec2>& polygon) {
  const std::size_t n = polygon.size();
  int left = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const int side = side_of(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]);
    if (side < 0) throw std::invalid_argument("the polygon is not convex and counter-clockwise");
    left += side;
  }
  if (left > 2 && !goes_round_once(polygon)) throw std::invalid_argument("the polygon goes round more than once");
  if (n < 3 || left < 3) throw std::invalid_argument("a polygon needs three corners that are not on one line");
}

enum class Beyond : std::uint8_t { no, touching, apart };

// Whether the other polygon lies on the right of an edge or on its line. inmost: its corner that is farthest to the
// left, before rounding; it decides most edges alone.
Beyond beyond(Vec2 from, Vec2 to, const std::vector<Vec2>& other, Vec2 inmost) {
  if (side_of(from, to, inmost) > 0) return Beyond::no;
  Beyond result = Beyond::apart;
  for (Vec2 p : other) {
    const int side = side_of(from, to, p);
    if (side > 0) return Beyond::no;
    if (side == 0) result = Beyond::touching;
  }
  return result;
}

}  // namespace

Projection project(const std::vector<Vec2>& points, Vec2 axis) {
  Projection interval{INFINITY, -INFINITY};
  for (Vec2 p : points) {
    const double value = p.x * axis.x + p.y * axis.y;
    interval = {std::min(interval.min, value), std::max(interval.max, value)};
  }
  return interval;
}

PolygonResult sat_polygons(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  require_convex(a);
  require_convex(b);
  PolygonResult result;
  result.penetration = INFINITY;
  bool apart = false, weakly_apart = false;
  const auto try_edges = [&](const std::vector<Vec2>& owner, const std::vector<Vec2>& other, bool owner_is_a) {
    for (std::size_t i = 0; i < owner.size(); ++i) {
      const Vec2 from = owner[i], to = owner[(i + 1) % owner.size()];
      const double length = std::hypot(to.x - from.x, to.y - from.y);
      if (length == 0) continue;
      const Vec2 outward{(to.y - from.y) / length, -(to.x - from.x) / length};
      // Projections are relative to a corner of the edge, so they keep their digits far from the origin.
      double nearest = INFINITY;
      Vec2 inmost = other[0];
      for (Vec2 p : other) {
        const double height = (p.x - from.x) * outward.x + (p.y - from.y) * outward.y;
        if (height < nearest) {
          nearest = height;
          inmost = p;
        }
      }
      const Beyond side = beyond(from, to, other, inmost);
      apart = apart || side == Beyond::apart;
      weakly_apart = weakly_apart || side != Beyond::no;
      if (-nearest < result.penetration) {
        result.penetration = -nearest;
        result.normal = owner_is_a ? outward : Vec2{-outward.x, -outward.y};
        result.edge_a = owner_is_a ? static_cast<int>(i) : -1;
        result.edge_b = owner_is_a ? -1 : static_cast<int>(i);
      }
    }
  };
  try_edges(a, b, true);
  try_edges(b, a, false);
  // If a line separates the interiors of closed polygons without a gap, the polygons share a point, unless another edge
  // normal has a gap. In the plane there are no other normals.
  result.outcome = apart ? Outcome::separated : weakly_apart ? Outcome::touching : Outcome::penetrating;
  return result;
}

}  // namespace satcheck
