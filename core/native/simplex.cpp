#include "simplex.hpp"

#include <algorithm>

namespace satcheck {

namespace {

struct Candidate {
  Vec3 v;
  double distance_squared = INFINITY;
  int index[3] = {0, 0, 0};
  double weight[3] = {1, 0, 0};
  int count = 0;

  void offer(const Candidate& other) {
    if (other.distance_squared < distance_squared) *this = other;
  }
};

Candidate closest_on_vertex(const Simplex& s, int i) {
  const Vec3 p = s.vertex[i].w;
  return {p, norm_squared(p), {i, 0, 0}, {1, 0, 0}, 1};
}

Candidate closest_on_segment(const Simplex& s, int i, int j) {
  const Vec3 p = s.vertex[i].w, q = s.vertex[j].w, e = q - p;
  const double length_squared = norm_squared(e);
  const double along = -dot(p, e);
  if (!(along > 0)) return closest_on_vertex(s, i);
  if (!(along < length_squared)) return closest_on_vertex(s, j);
  // The foot is measured from the nearer end, where the subtraction loses least.
  const double t = along / length_squared;
  Vec3 v = t <= 0.5 ? p + e * t : q - e * (dot(q, e) / length_squared);
  // Cancellation leaves a component along the edge; without it all of the edge has one support value,
  // and the duality gap can close however small v is.
  v = v - e * (dot(v, e) / length_squared);
  return {v, norm_squared(v), {i, j, 0}, {1 - t, t, 0}, 2};
}

Candidate closest_on_triangle(const Simplex& s, int i, int j, int k) {
  const Vec3 p = s.vertex[i].w, q = s.vertex[j].w, r = s.vertex[k].w;
  const Vec3 n = cross(q - p, r - p);
  const double area_squared = norm_squared(n);
  const double wp = dot(n, cross(q, r)), wq = dot(n, cross(r, p)), wr = dot(n, cross(p, q));
  if (wp > 0 && wq > 0 && wr > 0) {
    // Along the normal, not as a weighted sum: the direction stays good however close the plane is.
    const Vec3 v = n * (dot(n, p) / area_squared);
    const double sum = wp + wq + wr;
    return {v, norm_squared(v), {i, j, k}, {wp / sum, wq / sum, wr / sum}, 3};
  }
  Candidate best;
  if (!(wr > 0)) best.offer(closest_on_segment(s, i, j));
  if (!(wp > 0)) best.offer(closest_on_segment(s, j, k));
  if (!(wq > 0)) best.offer(closest_on_segment(s, k, i));
  return best;
}

// Which faces of the tetrahedron have the origin on their outer side (or on their plane).
struct FaceSides {
  bool outside[4];  // face i lies opposite vertex i
  bool any() const { return outside[0] || outside[1] || outside[2] || outside[3]; }
};

FaceSides sides_of_origin(const Simplex& s) {
  const Vec3 a = s.vertex[0].w, b = s.vertex[1].w, c = s.vertex[2].w, d = s.vertex[3].w;
  // Signed volumes of the origin with each face: all of the sign of the whole when it is inside.
  const double va = dot(b, cross(d, c)), vb = dot(a, cross(c, d)), vc = dot(a, cross(d, b)), vd = dot(a, cross(b, c));
  const double whole = va + vb + vc + vd;
  return {{!(va * whole > 0), !(vb * whole > 0), !(vc * whole > 0), !(vd * whole > 0)}};
}

Candidate closest_on_faces(const Simplex& s, const FaceSides& sides) {
  Candidate best;
  if (sides.outside[3]) best.offer(closest_on_triangle(s, 0, 1, 2));
  if (sides.outside[2]) best.offer(closest_on_triangle(s, 0, 1, 3));
  if (sides.outside[1]) best.offer(closest_on_triangle(s, 0, 2, 3));
  if (sides.outside[0]) best.offer(closest_on_triangle(s, 1, 2, 3));
  return best;
}

}  // namespace

Vec3 Simplex::witness_a() const {
  Vec3 p;
  for (int i = 0; i < count; ++i) p = p + vertex[i].a * weight[i];
  return p;
}

Vec3 Simplex::witness_b() const {
  Vec3 p;
  for (int i = 0; i < count; ++i) p = p + vertex[i].b * weight[i];
  return p;
}

ClosestPoint reduce(Simplex& s) {
  Candidate best;
  if (s.count == 4) {
    const FaceSides sides = sides_of_origin(s);
    if (!sides.any()) return {{0, 0, 0}, true};
    best = closest_on_faces(s, sides);
  } else {
    best = s.count == 1   ? closest_on_vertex(s, 0)
           : s.count == 2 ? closest_on_segment(s, 0, 1)
                          : closest_on_triangle(s, 0, 1, 2);
  }
  // Indices may come in any order: pick out before writing over.
  SupportPoint kept[3];
  for (int i = 0; i < best.count; ++i) kept[i] = s.vertex[best.index[i]];
  for (int i = 0; i < best.count; ++i) {
    s.vertex[i] = kept[i];
    s.weight[i] = best.weight[i];
  }
  s.count = best.count;
  return {best.v, false};
}

}  // namespace satcheck
