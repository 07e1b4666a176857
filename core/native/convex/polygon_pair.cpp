// Two convex polygons are disjoint exactly if an edge normal of one of them separates them. If they overlap, the least
// overlap is also along an edge normal, because every edge of the Minkowski difference is an edge of A or of -B (C.
// Ericson, "Real-Time Collision Detection", 2004, 5.2). If they are apart, the nearest point of the difference lies on
// an edge that the origin is above, or it is a corner.

#include "convex/polygon_pair.hpp"

#include <algorithm>
#include <optional>

#include "convex/few_edges.hpp"
#include "convex/pair_order.hpp"
#include "convex/polygon_difference.hpp"
#include "convex/polygon_epa.hpp"
#include "exact/dyadic.hpp"

namespace satcheck {

namespace {

// A gap whose error is a larger share of it is computed exactly.
constexpr double kAccurate = 0x1p-40;
// Of exact_gap(): its quotient 4, the length 3 roundoffs, and one for this bound.
constexpr double kExactGapError = 8 * kUnitRoundoff;
// Of the distance of two corners: a difference, the sum of squares 2, the root, and one for this bound.
constexpr double kCornerError = 5 * kUnitRoundoff;
// Squares of lengths from 1e-240 to 1e45 stay in the range of float64 after this scaling.
constexpr double kNoUnderflow = 0x1p300;

Vec3 lift(Vec2 p) { return {p.x, p.y, 0}; }

bool boxes_apart(const ConvexPolygon& a, const ConvexPolygon& b) {
  return a.high.x < b.low.x || b.high.x < a.low.x || a.high.y < b.low.y || b.high.y < a.low.y;
}

Gap exact_gap(const DifferenceEdge& e) {
  const auto difference = [](double head, double tail) { return Dyadic(head) - Dyadic(tail); };
  const Dyadic ux = difference(e.to.x, e.from.x), uy = difference(e.to.y, e.from.y);
  const Dyadic wx = difference(e.corner.x, e.from.x), wy = difference(e.corner.y, e.from.y);
  const EdgeLength length = edge_length(e.from, e.to);
  const double gap = rounded_ratio((uy * wx - ux * wy) * Dyadic(length.scale), Dyadic(length.scaled));
  return {gap, kExactGapError * std::fabs(gap)};
}

Gap accurate_gap(const DifferenceEdge& e) {
  const Gap gap = gap_of(e);
  return gap.error <= kAccurate * std::fabs(gap.value) ? gap : exact_gap(e);
}

// Sign of (b - a) . (d - c).
int dot_sign(Vec2 a, Vec2 b, Vec2 c, Vec2 d) { return filtered_turn({a.y, -a.x}, {b.y, -b.x}, c, d); }

// Whether the foot of the corner on the line of the edge lies on the edge.
bool foot_on_edge(const DifferenceEdge& e) {
  return dot_sign(e.from, e.to, e.from, e.corner) >= 0 && dot_sign(e.to, e.from, e.to, e.corner) >= 0;
}

struct EdgeGap {
  DifferenceEdge edge{};
  Gap gap{-INFINITY, 0};
};

struct Proof {
  Outcome outcome;
  DifferenceEdge edge;  // that proves it, unless it is penetrating
};

Proof prove_outcome(const ConvexPolygon& a, const ConvexPolygon& b) {
  Proof proof{Outcome::penetrating, {}};
  walk_difference(a, b, [&](const DifferenceEdge& e) {
    const int sign = sign_of(e, gap_of(e));
    if (sign < 0 || (sign == 0 && !foot_on_edge(e))) return true;
    proof = {sign > 0 ? Outcome::separated : Outcome::touching, e};
    return false;
  });
  return proof;
}

// The widest gap of all edges of two polygons that overlap.
EdgeGap widest_gap(const ConvexPolygon& a, const ConvexPolygon& b) {
  EdgeGap widest;
  double reach = -INFINITY;
  walk_difference(a, b, [&](const DifferenceEdge& e) {
    const Gap gap = gap_of(e);
    if (gap.value > widest.gap.value) widest = {e, gap};
    reach = larger(reach, gap.value + gap.error);
    return true;
  });
  const double lower = widest.gap.value - widest.gap.error;
  if (reach - lower <= kAccurate * std::fabs(widest.gap.value)) return {widest.edge, {widest.gap.value, reach - widest.gap.value}};
  // Edges within the rounding errors compete in exact arithmetic.
  EdgeGap exact;
  walk_difference(a, b, [&](const DifferenceEdge& e) {
    const Gap rough = gap_of(e);
    if (rough.value + rough.error < lower) return true;
    const Gap gap = exact_gap(e);
    if (gap.value > exact.gap.value) exact = {e, gap};
    return true;
  });
  return exact;
}

void write(const EdgeGap& found, PairResult& result) {
  const auto& [e, gap] = found;
  const Vec2 foot = e.corner - e.normal * gap.value;
  result.has_distance = true;
  result.distance = gap.value;
  result.lower = gap.value - gap.error;
  result.upper = gap.value + gap.error;
  result.normal = lift(e.of_a ? e.normal : Vec2{} - e.normal);
  result.witness_a = lift(e.of_a ? foot : e.corner);
  result.witness_b = lift(e.of_a ? e.corner : foot);
  result.feature = e.of_a ? Feature::face_a : Feature::face_b;
  (e.of_a ? result.index_a : result.index_b) = e.index;
}

void write(Vec2 corner_a, Vec2 corner_b, PairResult& result) {
  const EdgeLength length = edge_length(corner_a, corner_b);
  const double distance = length.scaled / length.scale;
  result.has_distance = true;
  result.distance = distance;
  result.lower = distance - kCornerError * distance;
  result.upper = distance + kCornerError * distance;
  result.normal = lift((corner_b - corner_a) * (length.scale / length.scaled));
  result.witness_a = lift(corner_a);
  result.witness_b = lift(corner_b);
  result.feature = Feature::vertices;
}

// Whether the neighbours of a corner do not come nearer to a point than the corner does, along the line between them.
bool is_nearest_corner(const ConvexPolygon& p, std::uint32_t i, Vec2 point) {
  const Vec2 corner = p.corners[i];
  return dot_sign(corner, point, corner, p.corners[p.next(i)]) <= 0 &&
         dot_sign(corner, point, corner, p.corners[p.previous(i)]) <= 0;
}

// The edge between two corners of `owner`, if no corner of `other` is farther against its normal than corner j.
std::optional<DifferenceEdge> edge_between(const ConvexPolygon& owner, std::uint32_t i, std::uint32_t k,
                                           const ConvexPolygon& other, std::uint32_t j, bool of_a) {
  if (owner.next(k) == i) std::swap(i, k);
  if (owner.next(i) != k) return std::nullopt;
  const DifferenceEdge e{owner.corners[i], owner.corners[k], owner.normals[i], other.corners[j], i, of_a};
  if (filtered_turn(e.from, e.to, e.corner, other.corners[other.next(j)]) > 0) return std::nullopt;
  if (filtered_turn(e.from, e.to, e.corner, other.corners[other.previous(j)]) > 0) return std::nullopt;
  return e;
}

// An edge of the difference on the segment between two of its corners. If an edge of A is parallel to one of B, the
// segment may consist of both.
template <class Accept>
std::optional<DifferenceEdge> edge_on(const ConvexPolygon& a, const ConvexPolygon& b, const DifferenceCorner& p,
                                      const DifferenceCorner& q, Accept accept) {
  for (const DifferenceCorner* end : {&p, &q}) {
    if (const auto e = edge_between(a, p.i, q.i, b, end->j, true); e && accept(*e)) return e;
    if (const auto e = edge_between(b, p.j, q.j, a, end->i, false); e && accept(*e)) return e;
  }
  return std::nullopt;
}

// What GJK found, if it is proven: convex shapes have no other local minima of the distance.
bool write_proven(const ConvexPolygon& a, const ConvexPolygon& b, const PolygonGjk& found, PairResult& result) {
  const DifferenceCorner &p = found.simplex[0], &q = found.simplex[1];
  if (found.count == 1) {
    const Vec2 corner_a = a.corners[p.i], corner_b = b.corners[p.j];
    if (!is_nearest_corner(a, p.i, corner_b) || !is_nearest_corner(b, p.j, corner_a)) return false;
    write(corner_a, corner_b, result);
    return true;
  }
  const auto edge = edge_on(a, b, p, q, [](const DifferenceEdge& e) { return sign_of(e, gap_of(e)) > 0 && foot_on_edge(e); });
  if (edge) write({*edge, accurate_gap(*edge)}, result);
  return edge.has_value();
}

// The depth that EPA found, if its bounds are close.
bool write_depth(const ConvexPolygon& a, const ConvexPolygon& b, const PolygonGjk& found, PairResult& result) {
  const PolygonEpa nearest = epa(a, b, found);
  if (!nearest.closed) return false;
  const auto edge = edge_on(a, b, nearest.p, nearest.q, [](const DifferenceEdge&) { return true; });
  if (!edge) return false;
  const Gap gap = gap_of(*edge);
  const double error = larger(gap.error, -nearest.least - gap.value);
  if (error > kAccurate * std::fabs(gap.value)) return false;
  write({*edge, {gap.value, error}}, result);
  return true;
}

// The distance of two separated polygons by a walk over all edges.
void write_distance(const ConvexPolygon& a, const ConvexPolygon& b, PairResult& result) {
  std::optional<DifferenceEdge> edge;
  DifferenceEdge at_corner{};
  double least = INFINITY;
  walk_difference(a, b, [&](const DifferenceEdge& e) {
    const Vec2 w = (e.corner - e.from) * kNoUnderflow;
    if (const double squared = dot(w, w); squared < least) {
      least = squared;
      at_corner = e;
    }
    if (sign_of(e, gap_of(e)) > 0 && foot_on_edge(e)) edge = e;
    return !edge;
  });
  if (edge) {
    write({*edge, accurate_gap(*edge)}, result);
  } else if (at_corner.of_a) {
    write(at_corner.from, at_corner.corner, result);
  } else {
    write(at_corner.corner, at_corner.from, result);
  }
}

Vec2 between_centres(const ConvexPolygon& a, const ConvexPolygon& b) {
  const Vec2 between = (b.low + b.high) - (a.low + a.high);
  return between.x == 0 && between.y == 0 ? Vec2{1, 0} : between;
}

// The rest, by walks over all edges. known: the outcome is proven.
void settle_by_walks(const ConvexPolygon& a, const ConvexPolygon& b, Query query, std::optional<Outcome> known,
                     PairResult& result) {
  const Proof proof = known ? Proof{*known, {}} : prove_outcome(a, b);
  result.method = Method::sat;
  result.outcome = proof.outcome;
  if (query == Query::overlap) return;
  switch (proof.outcome) {
    case Outcome::separated:
      write_distance(a, b, result);
      break;
    case Outcome::touching:
      write({proof.edge, {0, 0}}, result);
      break;
    default:
      write(widest_gap(a, b), result);
  }
}

// Two polygons that are apart. towards: from A to B.
void settle_apart(const ConvexPolygon& a, const ConvexPolygon& b, Vec2 towards, PairResult& result) {
  result.outcome = Outcome::separated;
  result.method = Method::gjk;
  if (!write_proven(a, b, gjk(a, b, towards, true), result)) settle_by_walks(a, b, Query::distance, Outcome::separated, result);
}

void settle_few(const ConvexPolygon& a, const ConvexPolygon& b, Query query, PairResult& result) {
  const WidestEdge w = widest_of_few(a, b);
  const ConvexPolygon &owner = w.of_a ? a : b, &other = w.of_a ? b : a;
  const auto edge = edge_between(owner, w.edge, owner.next(w.edge), other, w.corner, w.of_a);
  result.method = Method::sat;
  std::optional<Outcome> outcome;
  if (w.gap > w.error) outcome = Outcome::separated;
  if (w.gap < -w.error) outcome = Outcome::penetrating;
  if (!outcome && edge) {
    const int sign = sign_of(*edge, gap_of(*edge));
    if (sign > 0) outcome = Outcome::separated;
    if (sign == 0 && foot_on_edge(*edge)) outcome = Outcome::touching;
  }
  if (outcome) result.outcome = *outcome;
  if (outcome && query == Query::overlap) return;
  const bool is_close = 2 * w.error <= kAccurate * std::fabs(w.gap);
  if (outcome == Outcome::separated && edge && foot_on_edge(*edge)) {
    write({*edge, accurate_gap(*edge)}, result);
  } else if (outcome == Outcome::separated) {
    settle_apart(a, b, w.of_a ? owner.normals[w.edge] : -owner.normals[w.edge], result);
  } else if (edge && outcome == Outcome::touching) {
    write({*edge, {0, 0}}, result);
  } else if (edge && outcome == Outcome::penetrating && is_close) {
    write({*edge, {w.gap, w.error}}, result);
  } else {
    settle_by_walks(a, b, query, outcome, result);
  }
}

void settle_many(const ConvexPolygon& a, const ConvexPolygon& b, Query query, PairResult& result) {
  const bool overlap = query == Query::overlap;
  const PolygonGjk found = gjk(a, b, between_centres(a, b), !overlap);
  const bool apart = found.finding == PolygonFinding::apart, meet = found.finding == PolygonFinding::meet;
  result.method = Method::gjk;
  result.outcome = apart ? Outcome::separated : Outcome::penetrating;
  if ((overlap && (apart || meet)) || (apart && write_proven(a, b, found, result))) return;
  if (meet) {
    result.method = Method::epa;
    if (write_depth(a, b, found, result)) return;
  }
  settle_by_walks(a, b, query, apart || meet ? std::optional(result.outcome) : std::nullopt, result);
}

PairResult check_in_order(const ConvexPolygon& a, const ConvexPolygon& b, Query query) {
  PairResult result;
  const bool apart = boxes_apart(a, b);
  if (apart && query == Query::overlap) {
    result.outcome = Outcome::separated;
    result.method = Method::sat;
  } else if (apart) {
    settle_apart(a, b, between_centres(a, b), result);
  } else if (have_few_corners(a, b)) {
    settle_few(a, b, query, result);
  } else {
    settle_many(a, b, query, result);
  }
  return result;
}

bool corners_less(const ConvexPolygon& a, const ConvexPolygon& b) {
  return std::lexicographical_compare(a.corners, a.corners + a.count, b.corners, b.corners + b.count,
                                      [](Vec2 p, Vec2 q) { return p.x != q.x ? p.x < q.x : p.y < q.y; });
}

// An order of polygons that does not depend on which is given first, as comes_before() of shapes.
bool comes_before(const ConvexPolygon& a, const ConvexPolygon& b) {
  return a.low.x != b.low.x ? a.low.x < b.low.x : a.low.y != b.low.y ? a.low.y < b.low.y : corners_less(a, b);
}

}  // namespace

PairResult check_polygons(const ConvexPolygon& a, const ConvexPolygon& b, Query query) {
  const ConvexPolygon* const polygons[2] = {&a, &b};
  const bool swapped = !comes_before(a, b);
  PairResult result = check_in_order(*polygons[swapped], *polygons[!swapped], query);
  if (swapped) mirror(result);
  return result;
}

}  // namespace satcheck
