#include "convex/simplex.hpp"

#include <algorithm>

namespace satcheck {

ClosestPoint closest_point(const Simplex& s) {
  return closest_point<false>(s.vertex[0].w, s.vertex[1].w, s.vertex[2].w, s.vertex[3].w, s.count);
}

namespace {

ClosestPoint closest_on_surface(const Simplex& s) {
  ClosestPointSearch search(s.vertex[0].w, s.vertex[1].w, s.vertex[2].w, s.vertex[3].w);
  search.offer_faces<0b111111u>(0b1111u);
  return search.best();
}

}  // namespace

// By elimination with row pivots: its residual is rounding noise even for thin tetrahedra. If the volumes are noise,
// their quotients (Cramer's rule) are noise too. N. J. Higham, "Accuracy and Stability of
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
  if (inside) return;
  keep(s, closest_on_surface(s));  // rounding puts the origin at a face
  normalize_weights(s);
}

}  // namespace satcheck
