// Expanding Polytope Algorithm: G. van den Bergen, "Proximity Queries and Penetration Depth
// Computation on 3D Game Objects" (2001). Deviations:
//
// - Faces are ordered by the *signed* distance of their plane from the origin, so the origin may lie
//   outside, on or inside the first tetrahedron: aligned and concentric shapes need no special case.
// - min over faces <= signed penetration <= support value along any axis. The loop ends when the two
//   meet, or on a negative support value, which is a separating axis.
// - A face counts as visible only beyond rounding noise. If rounding still breaks the polytope, the loop returns
//   `stalled`, and the caller uses another method.

#include "convex/epa.hpp"

#include <algorithm>
#include <initializer_list>

#include "convex/expanding_polytope.hpp"

namespace satcheck {

namespace {

// The most expansions for polytopes, a few seconds. Regular prisms of so many sides, one in the middle of the other, take
// more; the bounds are then close.
constexpr int kMostExpansions = 1 << 15;

// Not inlined, so that it is compiled for wide registers.
SATCHECK_WIDE SupportPoint farthest(const MinkowskiDifference& m, Vec3 direction) { return m.support(direction); }

// The points of the seed that add a dimension beyond noise, and further support points, up to four in all. If A - B is
// flat, there are fewer, and `flat_normal` is set.
Simplex thick_tetrahedron(const MinkowskiDifference& m, const Simplex& seed, Vec3& flat_normal) {
  const double thin = kFlat * m.scale;
  Simplex s;
  // The distance of a point from the affine hull of s.
  const auto height = [&](Vec3 w) {
    const Vec3 p = s.vertex[0].w, e = s.vertex[1].w - p;
    if (s.count == 1) return norm(w - p);
    if (s.count == 2) return norm(cross(e, w - p)) / norm(e);
    const Vec3 n = cross(e, s.vertex[2].w - p);
    return std::fabs(dot(n, w - p)) / norm(n);
  };
  for (int i = 0; i < seed.count; ++i) {
    if (s.count == 0 || height(seed.vertex[i].w) > thin) s.add(seed.vertex[i]);
  }
  if (s.count == 0) s.add(m.support({1, 0, 0}));
  const auto add_farthest = [&](std::initializer_list<Vec3> directions) {
    SupportPoint best{};
    double best_height = -1;
    for (const Vec3 direction : directions) {
      const SupportPoint p = farthest(m, direction);
      const double h = height(p.w);
      if (h > best_height) {
        best = p;
        best_height = h;
      }
    }
    if (best_height > thin) s.add(best);
    return best_height > thin;
  };
  const Vec3 p = s.vertex[0].w;
  if (s.count == 1 && !add_farthest({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})) {
    flat_normal = norm(p) > 0 ? p * (1 / norm(p)) : Vec3{0, 0, 1};  // a point
    return s;
  }
  if (s.count == 2) {
    const Vec3 e = s.vertex[1].w - p, unit = e * (1 / norm(e));
    const Vec3 across = any_perpendicular(unit), third = cross(unit, across);
    if (!add_farthest({across, -across, third, -third})) {
      const Vec3 off = p - unit * dot(unit, p);  // a segment: away from the origin, or any perpendicular
      flat_normal = norm(off) > thin ? off * (1 / norm(off)) : across;
      return s;
    }
  }
  if (s.count == 3) {
    const Vec3 n = cross(s.vertex[1].w - p, s.vertex[2].w - p);
    flat_normal = n * (1 / norm(n));
    add_farthest({flat_normal, -flat_normal});
  }
  return s;
}

// An edge of A and an edge of B form a parallelogram of A - B, and a face is half of it. Replaces such a face by the
// other half. Returns false for any other face.
bool turn_to_other_half(Simplex& face) {
  for (int corner = 0; corner < 3; ++corner) {
    SupportPoint& c = face.vertex[corner];
    const auto shares_both = [&](const SupportPoint& p, const SupportPoint& q) {
      return p.index_a == c.index_a && q.index_b == c.index_b && c.index_a != kNoIndex && c.index_b != kNoIndex;
    };
    const SupportPoint &p = face.vertex[(corner + 1) % 3], &q = face.vertex[(corner + 2) % 3];
    const bool forward = shares_both(p, q);
    if (!forward && !shares_both(q, p)) continue;
    const SupportPoint &of_b = forward ? p : q, &of_a = forward ? q : p;
    c = {of_a.a - (of_b.a - of_b.w), of_a.a, of_a.index_a, of_b.index_b};
    return true;
  }
  return false;
}

// Sets the weights of the face to its point closest to `foot`, a point of its plane.
double weigh(Simplex& face, Vec3 foot) {
  for (SupportPoint& p : face.vertex) p.w = p.w - foot;
  const ClosestPoint closest = closest_point(face);
  for (SupportPoint& p : face.vertex) p.w = p.w + foot;
  keep(face, closest);
  normalize_weights(face);
  return closest.distance_squared;
}

// The facet with the weights of the origin's projection onto its plane, clamped to the facet.
Simplex weighted_facet(const ExpandingPolytope& polytope, HalfEdge f) {
  const Vec3 foot = polytope.normal(f) * polytope.distance(f);
  const auto corners = [&] {
    Simplex s;
    for (int corner = 0; corner < 3; ++corner) s.add(polytope.vertex(f, corner));
    return s;
  };
  Simplex facet = corners();
  const double miss = weigh(facet, foot);
  if (facet.count == 3) return facet;
  Simplex other = corners();
  if (turn_to_other_half(other) && weigh(other, foot) < miss) facet = other;
  return facet;
}

// For a set without volume: the support value along the normal of its plane is the distance of the plane from the
// origin.
void set_flat(EpaResult& result, const MinkowskiDifference& m, Vec3 flat_normal) {
  const double towards = dot(flat_normal, m.support(flat_normal).w);
  const double against = dot(-flat_normal, m.support(-flat_normal).w);
  result.status = EpaResult::Status::flat;
  result.axis = towards <= against ? flat_normal : -flat_normal;
  result.upper = std::min(towards, against);
}

}  // namespace

SATCHECK_WIDE EpaResult epa(const MinkowskiDifference& m, const Simplex& seed, double enough) {
  ExpandingPolytope& polytope = ExpandingPolytope::of_thread();
  EpaResult result;
  polytope.clear(m);
  if (seed.count < 4 || !polytope.start(seed)) {
    Vec3 flat_normal;
    const Simplex tetrahedron = thick_tetrahedron(m, seed, flat_normal);
    if (tetrahedron.count < 4) {
      set_flat(result, m, flat_normal);
      return result;
    }
    polytope.clear(m);
    if (!polytope.start(tetrahedron)) {  // a needle: no polytope, but every axis bounds the penetration
      const Vec3 p = tetrahedron.vertex[0].w;
      const Vec3 n = cross(tetrahedron.vertex[1].w - p, tetrahedron.vertex[2].w - p);
      set_flat(result, m, n * (1 / norm(n)));
      result.status = EpaResult::Status::stalled;
      return result;
    }
  }
  const double noise = m.support_error();
  const double closed = (m.curved ? kCurvedFacetGap : kVisible) * m.scale;
  for (;;) {
    const HalfEdge f = polytope.closest_face();
    const Vec3 normal = polytope.normal(f);
    const double distance = polytope.distance(f);
    const SupportPoint w = m.support(normal);
    const double support = dot(normal, w.w);
    ++result.iterations;
    const bool known = polytope.contains(w);
    const bool facet_of_difference = support - distance <= closed || (known && polytope.has_vertex(f, w));
    if (support < result.upper || facet_of_difference) {
      result.upper = support;
      result.axis = normal;
    }
    if (support < -noise) {
      result.status = EpaResult::Status::separated;
      return result;
    }
    if (distance > enough + noise && polytope.least_proven_distance(f) > enough + noise) {
      result.lower = polytope.least_proven_distance(f);
      result.status = EpaResult::Status::depth;
      return result;
    }
    if (facet_of_difference) {
      // On curved shapes the last facets are slivers, so an earlier bound may be better.
      result.lower = std::max(m.curved ? result.lower : -INFINITY, polytope.least_proven_distance(f));
      result.facet = weighted_facet(polytope, f);
      result.status = EpaResult::Status::depth;
      return result;
    }
    // An existing vertex is outside a face: rounding has bent the polytope, and the loop might never end. The proven
    // bounds stay valid.
    if (m.curved) {
      result.lower = std::max(result.lower, polytope.least_proven_distance(f));
      result.status = EpaResult::Status::bounded;
      if (result.iterations >= kCurvedExpansions) return result;
    } else {
      result.lower = distance - m.support_error();
    }
    if (known || result.iterations >= kMostExpansions || !polytope.expand(w, f)) return result;
  }
}

ExpandingPolytope& ExpandingPolytope::of_thread() {
  thread_local ExpandingPolytope polytope;
  return polytope;
}

void ExpandingPolytope::grow() {
  room_ = 2 * std::max(2 * blocks_used_, vertices_used_) + 32;
  blocks_.resize(room_);
  faces_in_.resize(room_);
  free_.resize(room_);
  fan_.resize(room_);
  vertices_.resize(room_);
  const std::size_t edges = 4 * room_ + 8;
  horizon_.resize(edges);
  tails_.resize(edges);
  pending_.resize(edges);
}

}  // namespace satcheck
