// The boundary of the Minkowski difference of two convex polygons, all points b - a: the edges of B and of -A, merged by
// their directions (L. Guibas, R. Seidel, "Computing convolutions by reciprocal search", 1987). The polygons share a
// point exactly if the origin is in it. The nearest point of this boundary gives the depth and the distance.
//
// A float64 filter and exact signs decide every comparison, so the walk is the exact boundary.
#pragma once

#include "base/rounding.hpp"
#include "convex/convex_polygon.hpp"
#include "exact/predicates.hpp"

namespace satcheck {

// turn_sign(), but the usual case is inlined.
inline int filtered_turn(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const Vec2 u = b - a, v = d - c;
  const double left = u.x * v.y, right = u.y * v.x;
  constexpr double kRoundoffs = 5;  // two differences, a product, the sum, and one for this bound
  const double bound = kRoundoffs * kUnitRoundoff * (std::fabs(left) + std::fabs(right)) + kUnderflow;
  if (left - right > bound) return 1;
  if (left - right < -bound) return -1;
  if ((u.x == 0 || v.y == 0) && (u.y == 0 || v.x == 0)) return 0;  // as along the axes
  return turn_sign(a, b, c, d);
}

// An edge of one polygon, with the corner of the other one that is farthest against its normal.
struct DifferenceEdge {
  Vec2 from, to, normal;  // of the owner; the normal points out of it
  Vec2 corner;            // of the other polygon
  std::uint32_t index;    // of the edge
  bool of_a;              // the owner is A
};

// How far the corner lies outside of the line of the edge: |exact - value| <= error.
struct Gap {
  double value, error;
};

inline Gap gap_of(const DifferenceEdge& e) {
  const Vec2 w = e.corner - e.from;
  const double x = e.normal.x * w.x, y = e.normal.y * w.y;
  // The normal, the difference, the product, the sum, and one for this bound.
  constexpr double kRoundoffs = kEdgeNormalRoundoffs + 4;
  return {x + y, kRoundoffs * kUnitRoundoff * (std::fabs(x) + std::fabs(y)) + kUnderflow};
}

// -1 inside, 0 on the line, +1 outside, exactly.
inline int sign_of(const DifferenceEdge& e, Gap gap) {
  if (gap.value > gap.error) return 1;
  if (gap.value < -gap.error) return -1;
  return -filtered_turn(e.from, e.to, e.from, e.corner);
}

// Whether edge j of B comes before edge i of -A in a walk that is about to take one of them.
inline bool b_comes_first(const ConvexPolygon& a, std::uint32_t i, const ConvexPolygon& b, std::uint32_t j) {
  const double turn = cross(a.normals[i], b.normals[j]);
  // Both normals, a product and the sum; the products of two unit vectors add up to at most 1.
  constexpr double kError = (2 * kEdgeNormalRoundoffs + 3) * kUnitRoundoff;
  if (std::fabs(turn) > kError) return turn > 0;
  return turn_sign(a.corners[i], a.corners[a.next(i)], b.corners[j], b.corners[b.next(j)]) > 0;
}

// Calls visit(DifferenceEdge) for every edge of the difference, counter-clockwise, until it returns false.
template <class Visit>
void walk_difference(const ConvexPolygon& a, const ConvexPolygon& b, Visit visit) {
  // The lowest corner of the difference. From here on, directions turn from +x all around.
  const ConvexPolygon* const polygons[2] = {&a, &b};
  std::uint32_t at[2] = {a.highest, b.lowest}, left[2] = {a.count, b.count};
  while (left[0] + left[1] > 0) {
    // Indexed by the owner instead of branches, because the order is unpredictable.
    const bool b_first = b_comes_first(a, at[0], b, at[1]);
    const bool owner = (left[1] != 0) & (b_first | (left[0] == 0));
    const ConvexPolygon& p = *polygons[owner];
    const std::uint32_t edge = at[owner];
    at[owner] = p.next(edge);
    --left[owner];
    const Vec2 corner = polygons[!owner]->corners[at[!owner]];
    if (!visit(DifferenceEdge{p.corners[edge], p.corners[at[owner]], p.normals[edge], corner, edge, !owner})) return;
  }
}

}  // namespace satcheck
