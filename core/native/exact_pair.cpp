// Every facet of A - B is a face of A, a face of -B, or spanned by an edge of each, so "does a plane
// separate the hulls, at least weakly" is a finite question about signs of determinants of
// coordinate differences. The float64 supports leave only the axes within `slack` of separating.

#include "exact_pair.hpp"

#include <algorithm>

#include "predicates.hpp"
#include "tolerances.hpp"

namespace satcheck {

namespace {

enum class Separation { none, weak, strict };

struct Hull {
  Polytope polytope;
  std::vector<Vec3> relative;  // vertices minus the common centre, for the float64 filter only
  double extent = 0;

  Hull(const std::vector<Vec3>& points, Vec3 centre) : polytope(convex_hull(points)) {
    for (Vec3 p : polytope.vertices) {
      relative.push_back(p - centre);
      extent = std::fmax(extent, max_abs(relative.back()));
    }
  }
};

// A unit axis in float64 and how far it may be from the true one, in radians.
struct RoundedAxis {
  Vec3 unit;
  double error = INFINITY;
};

RoundedAxis axis_across(Vec3 u, Vec3 v) {
  const Vec3 n = cross(u, v);
  const double length = norm(n);
  // Each component of the product carries 3 roundings of terms no larger than |u| |v|; the inputs,
  // differences of coordinates, one more each; times sqrt(3) for the vector: under 12.
  const double error = 12 * kUnitRoundoff * norm(u) * norm(v) / length;
  if (!(error < kTrustedAxis)) return {};
  return {n * (1 / length), error};
}

// Three corners of face f that span its plane: the widest triangle of a fan, for the filter's sake.
Triangle corners_of(const Polytope& p, std::size_t f) {
  const std::uint32_t first = p.face_offset[f], end = p.face_offset[f + 1];
  Triangle best{};
  double widest = -1;
  for (std::uint32_t i = first + 1; i + 1 < end; ++i) {
    const Triangle t{p.face_vertex[first], p.face_vertex[i], p.face_vertex[i + 1]};
    const double area = norm(cross(p.vertices[t[1]] - p.vertices[t[0]], p.vertices[t[2]] - p.vertices[t[0]]));
    if (area > widest) {
      widest = area;
      best = t;
    }
  }
  return best;
}

// `owner` lies on or below each of its own faces, exactly; the sign of `other` decides.
Separation across_face(const Polytope& owner, const Triangle& t, const Polytope& other) {
  bool touches = false;
  for (Vec3 p : other.vertices) {
    const int side = orientation(owner.vertices[t[0]], owner.vertices[t[1]], owner.vertices[t[2]], p);
    if (side < 0) return Separation::none;
    touches = touches || side == 0;
  }
  return touches ? Separation::weak : Separation::strict;
}

struct Segment {
  Vec3 tail, head;
};

// The planes parallel to both edges: is A on one side and B on the other of the one through A's edge?
Separation across_edges(const Polytope& a, Segment ea, const Polytope& b, Segment eb) {
  int a_min = 1, a_max = -1, b_min = 1, b_max = -1;
  for (Vec3 p : a.vertices) {
    const int side = determinant_sign(ea.tail, ea.head, eb.tail, eb.head, ea.tail, p);
    a_min = std::min(a_min, side);
    a_max = std::max(a_max, side);
    if (a_min < 0 && a_max > 0) return Separation::none;
  }
  for (Vec3 p : b.vertices) {
    const int side = determinant_sign(ea.tail, ea.head, eb.tail, eb.head, ea.tail, p);
    b_min = std::min(b_min, side);
    b_max = std::max(b_max, side);
    if (b_min < 0 && b_max > 0) return Separation::none;
  }
  if (a_min == 0 && a_max == 0 && b_min == 0 && b_max == 0) return Separation::none;  // parallel: no axis
  if ((a_max <= 0 && b_min > 0) || (a_min >= 0 && b_max < 0)) return Separation::strict;
  if ((a_max <= 0 && b_min >= 0) || (a_min >= 0 && b_max <= 0)) return Separation::weak;
  return Separation::none;
}

std::vector<Segment> edges_of(const Polytope& p) {
  std::vector<Segment> edges;
  if (p.dimension == 1) edges.push_back({p.vertices[0], p.vertices[1]});
  for (const PolytopeEdge& e : p.edges) edges.push_back({p.vertices[e.tail], p.vertices[e.head]});
  return edges;
}

class ExactPair {
 public:
  ExactPair(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double slack)
      : a_(a, a.front()), b_(b, a.front()), slack_(slack) {}

  Outcome decide() {
    // Two flats whose dimensions add up to less than three span no volume between them.
    const bool spans_volume = a_.polytope.dimension + b_.polytope.dimension >= 3;
    Separation best = std::max(best_face_axis(a_, b_, 1), best_face_axis(b_, a_, -1));
    if (best != Separation::strict) best = std::max(best, best_edge_axis());
    if (best == Separation::strict) return Outcome::separated;
    if (best == Separation::none && spans_volume) return Outcome::penetrating;
    return Outcome::touching;
  }

 private:
  // Can this axis separate, even weakly, once its own error is granted? Vertices that refuted the last
  // axis are tried first: most axes fall at once.
  bool worth_testing(const RoundedAxis& axis, Vec3 sign_unit) const {
    const double allowed = slack_ + axis.error * 2 * (a_.extent + b_.extent);
    const auto lies_beyond = [&](std::size_t i, std::size_t j) {
      return dot(sign_unit, a_.relative[i] - b_.relative[j]) > allowed;
    };
    if (lies_beyond(last_a_, last_b_)) return false;
    for (std::size_t i = 0; i < a_.relative.size(); ++i) {
      if (lies_beyond(i, last_b_)) {
        last_a_ = i;
        return false;
      }
    }
    for (std::size_t i = 0; i < a_.relative.size(); ++i) {
      if (dot(sign_unit, a_.relative[i] - a_.relative[last_a_]) > 0) last_a_ = i;
    }
    for (std::size_t j = 0; j < b_.relative.size(); ++j) {
      if (lies_beyond(last_a_, j)) {
        last_b_ = j;
        return false;
      }
    }
    return true;
  }

  Separation best_face_axis(const Hull& owner, const Hull& other, double sign) const {
    Separation best = Separation::none;
    for (std::size_t f = 0; f < owner.polytope.face_count(); ++f) {
      const Triangle t = corners_of(owner.polytope, f);
      const Vec3* v = owner.polytope.vertices.data();
      const RoundedAxis axis = axis_across(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]);
      if (std::isfinite(axis.error) && !worth_testing(axis, axis.unit * sign)) continue;
      best = std::max(best, across_face(owner.polytope, t, other.polytope));
      if (best == Separation::strict) break;
    }
    return best;
  }

  Separation best_edge_axis() const {
    Separation best = Separation::none;
    const std::vector<Segment> edges_b = edges_of(b_.polytope);
    for (const Segment& ea : edges_of(a_.polytope)) {
      for (const Segment& eb : edges_b) {
        const RoundedAxis axis = axis_across(ea.head - ea.tail, eb.head - eb.tail);
        const bool trusted = std::isfinite(axis.error);
        if (trusted && !worth_testing(axis, axis.unit) && !worth_testing(axis, -axis.unit)) continue;
        best = std::max(best, across_edges(a_.polytope, ea, b_.polytope, eb));
        if (best == Separation::strict) return best;
      }
    }
    return best;
  }

  Hull a_, b_;
  double slack_;
  mutable std::size_t last_a_ = 0, last_b_ = 0;
};

}  // namespace

Outcome decide_exactly(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double slack) {
  return ExactPair(a, b, slack).decide();
}

}  // namespace satcheck
