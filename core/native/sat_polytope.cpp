// Polytopes: an edge pair spans a facet of A - B exactly when the arc between the normals of the two
// faces at A's edge crosses the negated arc of B's edge on the Gauss map (Gregorius, GDC 2013).
// Deviation: arcs that come too close to call are projected in full instead of being decided by
// a sign that is rounding noise.

#include <algorithm>

#include "sat.hpp"
#include "tolerances.hpp"

namespace satcheck {

namespace {

struct PlacedEdge {
  Vec3 tail, direction;        // unit direction
  Vec3 normal_left, normal_right;
};

std::vector<PlacedEdge> place_edges(const Polytope& polytope, const Pose& pose, double normal_sign) {
  std::vector<PlacedEdge> edges;
  edges.reserve(polytope.edges.size());
  for (const PolytopeEdge& e : polytope.edges) {
    const Vec3 tail = pose * polytope.vertices[e.tail];
    const Vec3 d = pose.rotation * (polytope.vertices[e.head] - polytope.vertices[e.tail]);
    edges.push_back({tail, d * (1 / norm(d)), pose.rotation * polytope.face_normal[e.left] * normal_sign,
                     pose.rotation * polytope.face_normal[e.right] * normal_sign});
  }
  return edges;
}

enum class Arcs { apart, uncertain, cross };

Arcs classify_arcs(const PlacedEdge& a, const PlacedEdge& b) {
  const double b_left = dot(b.normal_left, a.direction), b_right = dot(b.normal_right, a.direction);
  if ((b_left > kArcUncertain && b_right > kArcUncertain) || (b_left < -kArcUncertain && b_right < -kArcUncertain)) {
    return Arcs::apart;
  }
  const double a_left = dot(a.normal_left, b.direction), a_right = dot(a.normal_right, b.direction);
  if ((a_left > kArcUncertain && a_right > kArcUncertain) || (a_left < -kArcUncertain && a_right < -kArcUncertain)) {
    return Arcs::apart;
  }
  const double least = std::min({std::fabs(b_left), std::fabs(b_right), std::fabs(a_left), std::fabs(a_right)});
  if (least <= kArcUncertain) return Arcs::uncertain;
  // Both arcs cross the other's great circle; they meet unless they do so on opposite sides.
  const Vec3 n = cross(a.direction, b.direction);
  const bool same_side = (dot(n, a.normal_left + a.normal_right) > 0) == (dot(n, b.normal_left + b.normal_right) > 0);
  return same_side ? Arcs::cross : Arcs::apart;
}

double support_along(const MinkowskiDifference& m, Vec3 axis) { return dot(axis, m.support(axis).w); }

}  // namespace

SatResult sat_polytopes(const MinkowskiDifference& m, SatGoal goal) {
  const double noise = m.support_error(), tie = kVisible * m.scale;
  SatResult best;
  const auto offer = [&](double overlap, Vec3 axis, Feature feature, std::size_t index_a, std::size_t index_b) {
    if (!(overlap < best.penetration - tie)) return;
    best.penetration = overlap;
    best.axis = axis;
    best.feature = feature;
    best.index_a = static_cast<std::uint32_t>(index_a);
    best.index_b = static_cast<std::uint32_t>(index_b);
  };
  const auto separates = [&] { return goal == SatGoal::any_separating_axis && best.penetration < -noise; };

  for (std::size_t f = 0; f < m.a.polytope.face_count(); ++f) {
    const Vec3 axis = m.a.polytope.face_normal[f];
    ++best.axes_tested;
    offer(support_along(m, axis), axis, Feature::face_a, f, Shape::kNoIndex);
    if (separates()) return best;
  }
  for (std::size_t f = 0; f < m.b.polytope.face_count(); ++f) {
    const Vec3 axis = -(m.b_in_a.rotation * m.b.polytope.face_normal[f]);
    ++best.axes_tested;
    offer(support_along(m, axis), axis, Feature::face_b, Shape::kNoIndex, f);
    if (separates()) return best;
  }
  const std::vector<PlacedEdge> edges_a = place_edges(m.a.polytope, {}, 1);
  const std::vector<PlacedEdge> edges_b = place_edges(m.b.polytope, m.b_in_a, -1);
  for (std::size_t i = 0; i < edges_a.size(); ++i) {
    for (std::size_t j = 0; j < edges_b.size(); ++j) {
      const PlacedEdge &ea = edges_a[i], &eb = edges_b[j];
      const Arcs arcs = classify_arcs(ea, eb);
      if (arcs == Arcs::apart) continue;
      Vec3 axis = cross(ea.direction, eb.direction);
      const double length_squared = norm_squared(axis);
      if (length_squared < kParallelSquared) continue;
      axis = axis * (1 / std::sqrt(length_squared));
      if (dot(axis, ea.normal_left + ea.normal_right) < 0) axis = -axis;
      ++best.axes_tested;
      if (arcs == Arcs::cross) {
        const double overlap = dot(axis, ea.tail - eb.tail);  // the supports are these two edges
        if (overlap < best.penetration) offer(support_along(m, axis), axis, Feature::edge_edge, i, j);
      } else {
        offer(support_along(m, axis), axis, Feature::edge_edge, i, j);
        offer(support_along(m, -axis), -axis, Feature::edge_edge, i, j);
      }
      if (separates()) return best;
    }
  }
  return best;
}

}  // namespace satcheck
