// The point of a simplex closest to the origin.
#pragma once

#include "convex/minkowski.hpp"

namespace satcheck {

// Up to four support points of A - B and the weights of a point of their hull.
struct Simplex {
  SupportPoint vertex[4];
  double weight[4] = {1, 0, 0, 0};
  int count = 0;

  void add(const SupportPoint& point) { vertex[count++] = point; }
  bool contains(const SupportPoint& point) const {
    for (int i = 0; i < count; ++i) {
      if (vertex[i].same_as(point)) return true;
    }
    return false;
  }
  Vec3 witness_a() const;
  Vec3 witness_b() const;
};

// The point of a simplex closest to the origin, and the vertices that carry it.
struct ClosestPoint {
  Vec3 v;
  double distance_squared = INFINITY;
  int index[3] = {0, 0, 0};
  double weight[3] = {1, 0, 0};
  int count = 0;          // 0: the tetrahedron encloses the origin
  void offer(const ClosestPoint& other) {
    if (other.distance_squared < distance_squared) *this = other;
  }
};

// Deviation from Ericson, "Real-Time Collision Detection" (2004), 5.1, and from Montanari,
// Petrinic and Barbieri, "Improving the GJK Algorithm" (2017): no chain of region tests. The inside
// of a face counts only when all its weights are positive; otherwise the edges of non-positive weight
// compete by distance, so a misjudged sign costs accuracy in the last digit, not the region.
ClosestPoint closest_point(const Simplex& simplex);

// The same of a simplex whose last vertex is needed: one without which there is no closer point. What the
// other vertices span is left out. Count 0 at a distance above 0 means that rounding left nothing.
ClosestPoint closest_point_with_last(const Simplex& simplex);

// A ball around the origin that a tetrahedron holds: a lower bound of its radius, without the rounding of
// the vertices. 0 or less when the origin may lie outside.
double enclosed_radius(const Simplex& simplex);

// Weights of the origin in a tetrahedron that encloses it, however thin. One that rounding cannot tell
// from its faces loses the vertices that carry nothing.
void weigh_enclosed_origin(Simplex& simplex);

// Keeps only the vertices that carry the closest point, with their weights.
void keep(Simplex& simplex, const ClosestPoint& closest);

}  // namespace satcheck
