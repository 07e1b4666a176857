// Polytopes: an edge pair spans a facet of A - B exactly when the arc between the normals of the two
// faces at A's edge crosses the negated arc of B's edge on the Gauss map (Gregorius, GDC 2013).
// Deviations: if the sign for two arcs is rounding noise, both shapes are projected completely on their axis. Nearly
// parallel edges count too: with a shorter cross product its direction is less accurate, and the lower bound is lower.

#include <algorithm>

#include "base/rounding.hpp"
#include "convex/sat.hpp"

namespace satcheck {

namespace {

// B's edges in A's frame, with the normals of -B.
void place_arcs(const std::vector<EdgeArc>& arcs, const Pose& pose, std::vector<EdgeArc>& placed) {
  placed.clear();
  for (const EdgeArc& e : arcs) {
    placed.push_back({pose * e.tail, pose.rotation * e.direction, -(pose.rotation * e.normal_left),
                      -(pose.rotation * e.normal_right)});
  }
}

enum class Arcs { apart, uncertain, cross };

Arcs classify_arcs(const EdgeArc& a, const EdgeArc& b) {
  const double b_left = dot(b.normal_left, a.direction), b_right = dot(b.normal_right, a.direction);
  const double b_least = std::fmin(std::fabs(b_left), std::fabs(b_right));
  if (b_left * b_right > 0 && b_least > kArcUncertain) return Arcs::apart;
  const double a_left = dot(a.normal_left, b.direction), a_right = dot(a.normal_right, b.direction);
  const double a_least = std::fmin(std::fabs(a_left), std::fabs(a_right));
  if (a_left * a_right > 0 && a_least > kArcUncertain) return Arcs::apart;
  if (std::fmin(a_least, b_least) <= kArcUncertain) return Arcs::uncertain;
  // Each arc crosses the other's great circle. The arcs meet unless they cross on opposite sides. An arc of half a
  // circle, between the faces of a sliver, may lie on either side.
  const Vec3 n = cross(a.direction, b.direction);
  const double a_side = dot(n, a.normal_left + a.normal_right), b_side = dot(n, b.normal_left + b.normal_right);
  const double least = std::fmin(std::fabs(a_side), std::fabs(b_side));
  if (least * least <= kArcUncertain * kArcUncertain * norm_squared(n)) return Arcs::uncertain;
  return (a_side > 0) == (b_side > 0) ? Arcs::cross : Arcs::apart;
}

SATCHECK_WIDE double overlap_along(const MinkowskiDifference& m, Vec3 axis) { return dot(axis, m.support(axis).w); }

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
    offer(overlap_along(m, axis), axis, Feature::face_a, f, kNoIndex);
    if (separates()) return best;
  }
  for (std::size_t f = 0; f < m.b.polytope.face_count(); ++f) {
    const Vec3 axis = -(m.b_in_a.rotation * m.b.polytope.face_normal[f]);
    ++best.axes_tested;
    offer(overlap_along(m, axis), axis, Feature::face_b, kNoIndex, f);
    if (separates()) return best;
  }
  thread_local std::vector<EdgeArc> arcs_b;
  place_arcs(m.b.arcs, m.b_in_a, arcs_b);
  best.lower = INFINITY;
  double narrow_facets = 0;
  for (std::size_t i = 0; i < m.a.arcs.size(); ++i) {
    for (std::size_t j = 0; j < arcs_b.size(); ++j) {
      const EdgeArc &ea = m.a.arcs[i], &eb = arcs_b[j];
      const Arcs arcs = classify_arcs(ea, eb);
      if (arcs == Arcs::apart) continue;
      Vec3 axis = cross(ea.direction, eb.direction);
      const double length_squared = norm_squared(axis);
      if (length_squared < kFlat * kFlat) {  // a facet this narrow is this close to its neighbours
        narrow_facets = 2 * kFlat * m.scale;
        continue;
      }
      const double length = std::sqrt(length_squared);
      axis = axis * (1 / length);
      if (dot(axis, ea.normal_left + ea.normal_right) < 0) axis = -axis;
      ++best.axes_tested;
      const auto project = [&](Vec3 along) {
        const double overlap = overlap_along(m, along);
        offer(overlap, along, Feature::edge_edge, i, j);
        best.lower = std::fmin(best.lower, overlap - kFlat * m.scale / length);
      };
      // If the arcs cross, the support is at least the reach of these two edges.
      const bool worth_it = dot(axis, ea.tail - eb.tail) - kFlat * m.scale / length < best.penetration;
      if (worth_it || arcs == Arcs::uncertain) project(axis);
      if (arcs == Arcs::uncertain) project(-axis);
      if (separates()) return best;
    }
  }
  best.lower = std::fmin(best.lower, best.penetration - tie) - narrow_facets;
  return best;
}

}  // namespace satcheck
