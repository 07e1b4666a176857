// Method: Philippe Guigue, Olivier Devillers, "Fast and Robust Triangle-Triangle Overlap Test Using
// Orientation Predicates" (2003): two triangles that straddle each other's planes meet when their
// intervals on the common line do, and the ends of the intervals compare by one orientation each.
// Where we deviate: the comparison is derived for any signs including zeros, strict overlap is distinguished from
// contact, and exact segment tests decide about coplanar or collinear triangles.
#include "exact/triangle_pair.hpp"

#include <algorithm>
#include <utility>

#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// Measured steps of two triangles, of which the plane of one does not separate them; more in one plane, or if one is a
// line.
constexpr std::uint64_t kNearWork = 60, kFlatWork = 90;

// Closed segments on one line (or points); order along a line is lexicographic order.
bool collinear_segments_meet(Vec3 p, Vec3 q, Vec3 r, Vec3 s) {
  if (coordinates_less(q, p)) std::swap(p, q);
  if (coordinates_less(s, r)) std::swap(r, s);
  return !coordinates_less(q, r) && !coordinates_less(s, p);
}

bool point_on_segment(Vec3 x, Vec3 p, Vec3 q, Budget* budget) {
  return collinear(p, q, x, budget) && collinear_segments_meet(x, x, p, q);
}

// Closed segments of positive length in a plane that the projection along `axis` does not flatten.
bool coplanar_segments_meet(Vec3 p, Vec3 q, Vec3 r, Vec3 s, int axis, Budget* budget) {
  const int pr = orientation_2d(p, q, r, axis, budget), ps = orientation_2d(p, q, s, axis, budget);
  if (pr == 0 && ps == 0) return collinear_segments_meet(p, q, r, s);
  if (pr * ps > 0) return false;
  return orientation_2d(r, s, p, axis, budget) * orientation_2d(r, s, q, axis, budget) <= 0;
}

bool segments_meet(Vec3 p, Vec3 q, Vec3 r, Vec3 s, Budget* budget = nullptr) {
  if (p == q) return point_on_segment(p, r, s, budget);
  if (r == s) return point_on_segment(r, p, q, budget);
  if (orientation(p, q, r, s, budget) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (orientation_2d(p, q, r, axis, budget) != 0 || orientation_2d(p, q, s, axis, budget) != 0) {
      return coplanar_segments_meet(p, q, r, s, axis, budget);
    }
  }
  return collinear_segments_meet(p, q, r, s);
}

// The ends of a collinear triangle.
std::pair<Vec3, Vec3> extremes(const Corners& t) {
  Vec3 low = t[0], high = t[0];
  for (const Vec3& p : t) {
    if (coordinates_less(p, low)) low = p;
    if (coordinates_less(high, p)) high = p;
  }
  return {low, high};
}

// Whether a line along an edge of one of two triangles in a plane has the other one strictly beyond it (nearest: -1), or
// beyond it and on it (0). Such a line exists if two convex sets have no common point, or no common area.
bool edge_separates(const Corners& a, const Corners& b, int drop_axis, int nearest, Budget* budget) {
  const auto edge_of = [&](const Corners& t, const Corners& other) {
    const int turn = orientation_2d(t[0], t[1], t[2], drop_axis, budget);
    for (int i = 0; i < 3; ++i) {
      const auto is_beyond = [&](Vec3 p) { return turn * orientation_2d(t[i], t[(i + 1) % 3], p, drop_axis, budget) <= nearest; };
      if (std::all_of(other.begin(), other.end(), is_beyond)) return true;
    }
    return false;
  };
  return edge_of(a, b) || edge_of(b, a);
}

bool any_edge_meets(const Corners& edges_of, const Corners& t, Budget* budget) {
  for (int i = 0; i < 3; ++i) {
    if (segment_meets_triangle(edges_of[i], edges_of[(i + 1) % 3], t, budget)) return true;
  }
  return false;
}

// Signs of the corners of `t` with respect to the plane of `plane`.
std::array<int, 3> sides(const TrianglePlane& plane, const Corners& t, Budget* budget = nullptr) {
  return {plane.side(t[0], budget), plane.side(t[1], budget), plane.side(t[2], budget)};
}
std::array<int, 3> sides(const Corners& plane, const Corners& t, Budget* budget = nullptr) {
  return sides(TrianglePlane(plane[0], plane[1], plane[2]), t, budget);
}

bool all_strictly_on_one_side(const std::array<int, 3>& s) {
  return s[0] == s[1] && s[1] == s[2] && s[0] != 0;
}
bool all_zero(const std::array<int, 3>& s) { return s[0] == 0 && s[1] == 0 && s[2] == 0; }
bool straddles(const std::array<int, 3>& s) {
  return (s[0] > 0 || s[1] > 0 || s[2] > 0) && (s[0] < 0 || s[1] < 0 || s[2] < 0);
}

// A triangle, starting at its lone corner. This corner is strictly higher (`direction` +1) or strictly lower (-1) than
// both others, by sign. Its two edges cross or reach the other plane.
struct Lone {
  Vec3 p, q, r;
  int direction;
};

Lone from_lone_corner(const Corners& t, const std::array<int, 3>& s) {
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3, last = (i + 2) % 3;
    if (s[i] > s[next] && s[i] > s[last]) return {t[i], t[next], t[last], 1};
    if (s[i] < s[next] && s[i] < s[last]) return {t[i], t[next], t[last], -1};
  }
  return {};  // three equal signs, which the callers exclude
}

// With d = normal(a) x normal(b): sign of (y - x) . d, where x is where the edge a.p -> ax meets the
// plane of b, and y where b.p -> by meets the plane of a.
int compare_along_line(const Lone& a, Vec3 ax, const Lone& b, Vec3 by, Budget* budget = nullptr) {
  return a.direction * b.direction * orientation(a.p, ax, b.p, by, budget);
}

// The ends of an interval along d, as the far ends of the edges that define them.
struct Interval {
  Vec3 low, high;
};
Interval interval_of_first(const Lone& a) {
  return a.direction > 0 ? Interval{a.r, a.q} : Interval{a.q, a.r};
}
Interval interval_of_second(const Lone& b) {
  return b.direction > 0 ? Interval{b.q, b.r} : Interval{b.r, b.q};
}

Vec3 plane_crossing(const Corners& plane, Vec3 p, Vec3 q) {
  const Vec3 normal = rounded_normal(plane[0], plane[1], plane[2]);
  const double hp = dot(normal, p - plane[0]), hq = dot(normal, q - plane[0]);
  const double t = hp == hq ? 0.5 : std::fmin(1.0, std::fmax(0.0, hp / (hp - hq)));
  return p + (q - p) * t;
}

// Where two edges of coplanar or collinear triangles meet.
Vec3 edge_meeting_point(const Corners& a, const Corners& b) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = a[i], q = a[(i + 1) % 3], r = b[k], s = b[(k + 1) % 3];
      if (!segments_meet(p, q, r, s)) continue;
      // The point of p q in the plane through r s across p q.
      const Vec3 u = q - p, v = s - r, across = cross(v, cross(u, v));
      const double speed = dot(u, across);
      const double t = speed == 0 ? 0.5 : dot(r - p, across) / speed;
      return p + u * std::fmin(1.0, std::fmax(0.0, t));
    }
  }
  return a[0];
}

}  // namespace

bool segment_meets_triangle(Vec3 p, Vec3 q, const Corners& t, Budget* budget) {
  if (is_collinear(t, budget)) {
    const auto [low, high] = extremes(t);
    return segments_meet(p, q, low, high, budget);
  }
  const int sp = orientation(t[0], t[1], t[2], p, budget), sq = orientation(t[0], t[1], t[2], q, budget);
  if (sp * sq > 0) return false;
  if (sp == 0 && plane_point_in_triangle(p, t[0], t[1], t[2], budget)) return true;
  if (sq == 0 && plane_point_in_triangle(q, t[0], t[1], t[2], budget)) return true;
  if (p == q) return false;
  if (sp == 0 && sq == 0) {
    const int axis = projection_axis(t[0], t[1], t[2], budget);
    for (int i = 0; i < 3; ++i) {
      if (coplanar_segments_meet(p, q, t[i], t[(i + 1) % 3], axis, budget)) return true;
    }
    return false;
  }
  if (sp == 0 || sq == 0) return false;
  const int a = orientation(p, q, t[0], t[1], budget), b = orientation(p, q, t[1], t[2], budget);
  if (a * b < 0) return false;
  const int c = orientation(p, q, t[2], t[0], budget);
  return a * c >= 0 && b * c >= 0;
}

TriangleContact classify(const Corners& a, const Corners& b, Budget* budget) {
  return classify(TrianglePlane(a[0], a[1], a[2]), b, budget);
}

TriangleContact classify(const TrianglePlane& plane, const Corners& b, Budget* budget) {
  const Corners a{plane.a, plane.b, plane.c};
  // With two common corners, neither triangle has points on both sides of the other.
  const auto common = std::count_if(b.begin(), b.end(), [&](Vec3 p) { return p == a[0] || p == a[1] || p == a[2]; });
  if (common >= 2) return TriangleContact::touching;
  const std::array<int, 3> sb = sides(plane, b, budget);
  if (all_strictly_on_one_side(sb)) return TriangleContact::disjoint;
  if (common == 1 && !straddles(sb)) return TriangleContact::touching;
  spend(budget, kNearWork);
  const std::array<int, 3> sa = sides(b, a, budget);
  if (all_strictly_on_one_side(sa)) return TriangleContact::disjoint;
  if (all_zero(sa) || all_zero(sb)) {
    spend(budget, kFlatWork);
    const bool lines = is_collinear(a, budget) || is_collinear(b, budget);
    const bool meet = lines ? any_edge_meets(a, b, budget) || any_edge_meets(b, a, budget)
                            : !edge_separates(a, b, projection_axis(a[0], a[1], a[2], budget), -1, budget);
    return meet ? TriangleContact::touching : TriangleContact::disjoint;
  }
  const Lone la = from_lone_corner(a, sa), lb = from_lone_corner(b, sb);
  const Interval ia = interval_of_first(la), ib = interval_of_second(lb);
  const int low_a_before_high_b = compare_along_line(la, ia.low, lb, ib.high, budget);
  if (low_a_before_high_b < 0) return TriangleContact::disjoint;
  const int low_b_before_high_a = -compare_along_line(la, ia.high, lb, ib.low, budget);
  if (low_b_before_high_a < 0) return TriangleContact::disjoint;
  const bool common_segment = low_a_before_high_b > 0 && low_b_before_high_a > 0;
  return common_segment && straddles(sa) && straddles(sb) ? TriangleContact::crossing
                                                          : TriangleContact::touching;
}

bool share_area(const Corners& a, const Corners& b, int drop_axis, Budget* budget) {
  return !edge_separates(a, b, drop_axis, 0, budget);
}

CoplanarOverlap coplanar_overlap(const Corners& a, const Corners& b, Budget* budget) {
  if (is_collinear(a, budget) || is_collinear(b, budget) || !all_zero(sides(a, b, budget))) return CoplanarOverlap::none;
  const int axis = projection_axis(a[0], a[1], a[2], budget);
  if (!share_area(a, b, axis, budget)) return CoplanarOverlap::none;
  const auto turn = [&](const Corners& t) { return orientation_2d(t[0], t[1], t[2], axis, budget); };
  const bool agree = turn(a) == turn(b);
  return agree ? CoplanarOverlap::agreeing : CoplanarOverlap::opposing;
}

std::array<PlaneMeeting, 2> crossing_ends(const Corners& a, const Corners& b) {
  const Lone la = from_lone_corner(a, sides(b, a)), lb = from_lone_corner(b, sides(a, b));
  const Interval ia = interval_of_first(la), ib = interval_of_second(lb);
  // The common segment runs from the later of the two low ends to the earlier of the high ends.
  const bool low_of_b = compare_along_line(la, ia.low, lb, ib.low) > 0;
  const bool high_of_a = compare_along_line(la, ia.high, lb, ib.high) > 0;
  return {low_of_b ? PlaneMeeting{a, lb.p, ib.low} : PlaneMeeting{b, la.p, ia.low},
          high_of_a ? PlaneMeeting{b, la.p, ia.high} : PlaneMeeting{a, lb.p, ib.high}};
}

Vec3 crossing_point(const Corners& a, const Corners& b) {
  const auto [low, high] = crossing_ends(a, b);
  return plane_crossing(low.plane, low.p, low.q) * 0.5 + plane_crossing(high.plane, high.p, high.q) * 0.5;
}

Vec3 contact_point(const Corners& a, const Corners& b) {
  for (const Vec3& p : a) {
    if (segment_meets_triangle(p, p, b)) return p;
  }
  for (const Vec3& p : b) {
    if (segment_meets_triangle(p, p, a)) return p;
  }
  // No corner lies in the other triangle. An edge passes through it, or two edges meet.
  const Corners* sheets[2] = {&a, &b};
  for (int s = 0; s < 2; ++s) {
    const Corners &edges = *sheets[s], &sheet = *sheets[1 - s];
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = edges[i], q = edges[(i + 1) % 3];
      if (!segment_meets_triangle(p, q, sheet)) continue;
      const int side_p = orientation(sheet[0], sheet[1], sheet[2], p);
      const int side_q = orientation(sheet[0], sheet[1], sheet[2], q);
      if (side_p * side_q < 0) return plane_crossing(sheet, p, q);
    }
  }
  return edge_meeting_point(a, b);
}

}  // namespace satcheck
