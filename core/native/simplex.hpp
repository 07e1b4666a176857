// The point of a simplex closest to the origin.
#pragma once

#include "minkowski.hpp"

namespace satcheck {

// Up to four support points of A - B and, after reduce(), the weights of the closest point.
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

struct ClosestPoint {
  Vec3 v;                // closest point of the simplex to the origin
  bool encloses = false;  // a tetrahedron around the origin; v is 0 then
};

// Finds the closest point and keeps only the vertices of the feature that carries it.
//
// Deviation from Ericson, "Real-Time Collision Detection" (2004), 5.1, and from Montanari,
// Petrinic and Barbieri, "Improving the GJK Algorithm" (2017): no chain of region tests. The inside
// of a face counts only when all its weights are positive; otherwise the edges of non-positive weight
// compete by distance, so a misjudged sign costs accuracy in the last digit, not the region.
ClosestPoint reduce(Simplex& simplex);

}  // namespace satcheck
