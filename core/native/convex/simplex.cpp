#include "convex/simplex.hpp"

#include <algorithm>

namespace satcheck {

namespace {

ClosestPoint closest_on_vertex(const Simplex& s, int i) {
  const Vec3 p = s.vertex[i].w;
  return {p, norm_squared(p), {i, 0, 0}, {1, 0, 0}, 1};
}

ClosestPoint closest_on_segment(const Simplex& s, int i, int j) {
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

// `without_k`: whether the edge from i to j counts.
ClosestPoint closest_on_triangle(const Simplex& s, int i, int j, int k, bool without_k = true) {
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
  ClosestPoint best;
  if (without_k && !(wr > 0)) best.offer(closest_on_segment(s, i, j));
  if (!(wp > 0)) best.offer(closest_on_segment(s, j, k));
  if (!(wq > 0)) best.offer(closest_on_segment(s, k, i));
  return best;
}

// Signed volumes of the origin with each face: all of the sign of the whole when it is inside.
struct Volumes {
  double opposite[4];  // face i lies opposite vertex i
  double whole() const { return opposite[0] + opposite[1] + opposite[2] + opposite[3]; }
};

Volumes volumes_of_origin(const Simplex& s) {
  const Vec3 a = s.vertex[0].w, b = s.vertex[1].w, c = s.vertex[2].w, d = s.vertex[3].w;
  return {{dot(b, cross(d, c)), dot(a, cross(c, d)), dot(a, cross(d, b)), dot(a, cross(b, c))}};
}

// Which faces of the tetrahedron have the origin on their outer side (or on their plane).
struct FaceSides {
  bool outside[4];
  bool any() const { return outside[0] || outside[1] || outside[2] || outside[3]; }
};

FaceSides sides_of_origin(const Volumes& v) {
  const double whole = v.whole();
  return {{!(v.opposite[0] * whole > 0), !(v.opposite[1] * whole > 0), !(v.opposite[2] * whole > 0),
           !(v.opposite[3] * whole > 0)}};
}

ClosestPoint closest_on_faces(const Simplex& s, const FaceSides& sides) {
  ClosestPoint best;
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
  for (int i = 0; i < count; ++i) p = p + (vertex[i].a - vertex[i].w) * weight[i];
  return p;
}

ClosestPoint closest_point(const Simplex& s) {
  if (s.count == 1) return closest_on_vertex(s, 0);
  if (s.count == 2) return closest_on_segment(s, 0, 1);
  if (s.count == 3) return closest_on_triangle(s, 0, 1, 2);
  const FaceSides sides = sides_of_origin(volumes_of_origin(s));
  return sides.any() ? closest_on_faces(s, sides) : ClosestPoint{{0, 0, 0}, 0, {0, 0, 0}, {0, 0, 0}, 0};
}

ClosestPoint closest_point_with_last(const Simplex& s) {
  if (s.count == 2) return closest_on_segment(s, 0, 1);
  if (s.count == 3) return closest_on_triangle(s, 0, 1, 2, false);
  const FaceSides sides = sides_of_origin(volumes_of_origin(s));
  if (!sides.any()) return {{0, 0, 0}, 0, {0, 0, 0}, {0, 0, 0}, 0};
  ClosestPoint best;
  if (sides.outside[2]) best.offer(closest_on_triangle(s, 0, 1, 3, false));
  if (sides.outside[1]) best.offer(closest_on_triangle(s, 0, 2, 3, false));
  if (sides.outside[0]) best.offer(closest_on_triangle(s, 1, 2, 3, false));
  return best;
}

// The height of the origin over a face is its volume over twice the area, both times 6; twice the area is
// at most (2 r)^2 where all vertices lie within r. A volume of 3 factors up to r carries at most 12
// roundoffs of sqrt(3) r^3 for its terms.
double enclosed_radius(const Simplex& s) {
  const Volumes v = volumes_of_origin(s);
  const double sign = v.opposite[0] > 0 ? 1 : -1;
  double least = INFINITY, farthest_squared = 0;
  for (int i = 0; i < 4; ++i) {
    least = smaller(least, sign * v.opposite[i]);
    farthest_squared = larger(farthest_squared, norm_squared(s.vertex[i].w));
  }
  return least / (4 * farthest_squared) - 8 * kUnitRoundoff * std::sqrt(farthest_squared);
}

// By elimination with row pivots: its residual is rounding, however thin the tetrahedron. Quotients of
// volumes (Cramer's rule) are noise where the volumes are. N. J. Higham, "Accuracy and Stability of
// Numerical Algorithms" (2002), 1.10.1 and 9.3.
void weigh_enclosed_origin(Simplex& s) {
  const Vec3 o = s.vertex[0].w, e = s.vertex[1].w - o, f = s.vertex[2].w - o, g = s.vertex[3].w - o;
  double row[3][4] = {{e.x, f.x, g.x, -o.x}, {e.y, f.y, g.y, -o.y}, {e.z, f.z, g.z, -o.z}};
  for (int k = 0; k < 3; ++k) {
    for (int i = k + 1; i < 3; ++i) {
      if (std::fabs(row[i][k]) > std::fabs(row[k][k])) std::swap(row[i], row[k]);
    }
    for (int i = k + 1; i < 3; ++i) {
      const double factor = row[i][k] / row[k][k];
      for (int j = k; j < 4; ++j) row[i][j] -= factor * row[k][j];
    }
  }
  s.weight[3] = row[2][3] / row[2][2];
  s.weight[2] = (row[1][3] - row[1][2] * s.weight[3]) / row[1][1];
  s.weight[1] = (row[0][3] - row[0][1] * s.weight[2] - row[0][2] * s.weight[3]) / row[0][0];
  s.weight[0] = 1 - s.weight[1] - s.weight[2] - s.weight[3];
  const bool inside = s.weight[0] >= 0 && s.weight[1] >= 0 && s.weight[2] >= 0 && s.weight[3] >= 0;
  if (!inside) keep(s, closest_on_faces(s, {{true, true, true, true}}));  // rounded out: it is at a face
}

void keep(Simplex& s, const ClosestPoint& closest) {
  SupportPoint kept[3];  // indices may come in any order: pick out before writing over
  for (int i = 0; i < closest.count; ++i) kept[i] = s.vertex[closest.index[i]];
  for (int i = 0; i < closest.count; ++i) {
    s.vertex[i] = kept[i];
    s.weight[i] = closest.weight[i];
  }
  s.count = closest.count;
}

}  // namespace satcheck
