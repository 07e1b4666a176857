// A simplex of support points, and the weights of a point of it.
#pragma once

#include "convex/closest_point.hpp"
#include "convex/minkowski.hpp"

namespace satcheck {

// Up to four support points of A - B and the weights of a point of their hull.
struct Simplex {
  SupportPoint vertex[4];
  double weight[4] = {1, 0, 0, 0};
  int count = 0;

  Simplex() = default;
  // One point, with copies of it in the places of the others, which takes less time than to clear them.
  explicit Simplex(const SupportPoint& point) : vertex{point, point, point, point}, count(1) {}

  void add(const SupportPoint& point) { vertex[count++] = point; }
  bool contains(const SupportPoint& point) const {
    for (int i = 0; i < count; ++i) {
      if (vertex[i].same_as(point)) return true;
    }
    return false;
  }
  Vec3 witness_a() const {
    Vec3 p;
    for (int i = 0; i < count; ++i) p = p + vertex[i].a * weight[i];
    return p;
  }
  Vec3 witness_b() const {
    Vec3 p;
    for (int i = 0; i < count; ++i) p = p + (vertex[i].a - vertex[i].w) * weight[i];
    return p;
  }
};

ClosestPoint closest_point(const Simplex& simplex);

// Weights of the origin in a tetrahedron that encloses it, even a thin one. If the origin is on a face up to rounding,
// vertices of weight 0 are dropped.
void weigh_enclosed_origin(Simplex& simplex);

// Keeps only the vertices that carry the closest point. Their weights are still shares.
SATCHECK_INLINE void keep(Simplex& s, const ClosestPoint& closest) {
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    if (!(closest.carriers >> i & 1)) continue;
    if (count != i) s.vertex[count] = s.vertex[i];
    s.weight[count++] = closest.share[i];
  }
  s.count = count;
}

// Turns shares into weights of sum 1.
inline void normalize_weights(Simplex& s) {
  double sum = 0;
  for (int i = 0; i < s.count; ++i) sum += s.weight[i];
  for (int i = 0; i < s.count; ++i) s.weight[i] /= sum;
}

}  // namespace satcheck
