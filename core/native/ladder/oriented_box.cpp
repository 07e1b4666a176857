// The test is that of box_axes.hpp, on fewer words: S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree" (1996), 15 axes.
// The products of edges are not scaled to unit length, because the rounding of a projection does not shrink with it.
#include "ladder/oriented_box.hpp"

#include <algorithm>

#include "base/rounding.hpp"

namespace satcheck {
namespace {

bool along_one_axis(Vec3 column) { return (column.x != 0) + (column.y != 0) + (column.z != 0) == 1; }

// The error of a gap from rounding, and from axes that are not exactly perpendicular.
struct Noise {
  double face, edge;
};

Noise noise_of(const OrientedBox& a, const OrientedBox& b, Vec3 offset) {
  const double reach = norm(a.half) + norm(b.half);
  const double placed = max_abs(a.centre) + max_abs(b.centre) + 2 * reach;
  const double face = kSupportError * (reach + max_abs(offset)) + kPlacementError * placed;
  return {face, face + 4 * kOrthogonality * reach};
}

// Orders boxes by size, then by place, so that both orders of a pair give the same answer.
bool comes_after(const OrientedBox& a, const OrientedBox& b) {
  return a.half == b.half ? coordinates_less(b.centre, a.centre) : coordinates_less(b.half, a.half);
}

Feature separating_axis(const OrientedBox& a, const OrientedBox& b) {
  double r[3][3], abs_r[3][3], t[3];
  const Vec3 offset = b.centre - a.centre;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) abs_r[i][j] = std::fabs(r[i][j] = dot(a.axis[i], b.axis[j]));
    t[i] = dot(a.axis[i], offset);
  }
  const Noise noise = noise_of(a, b, offset);
  const double ha[3] = {a.half.x, a.half.y, a.half.z}, hb[3] = {b.half.x, b.half.y, b.half.z};
  for (int i = 0; i < 3; ++i) {
    const double reach = ha[i] + (abs_r[i][0] * hb[0] + abs_r[i][1] * hb[1] + abs_r[i][2] * hb[2]);
    if (std::fabs(t[i]) - reach > noise.face) return Feature::face_a;
  }
  for (int j = 0; j < 3; ++j) {
    const double reach = hb[j] + (abs_r[0][j] * ha[0] + abs_r[1][j] * ha[1] + abs_r[2][j] * ha[2]);
    const double along = t[0] * r[0][j] + t[1] * r[1][j] + t[2] * r[2][j];
    if (std::fabs(along) - reach > noise.face) return Feature::face_b;
  }
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      if (1 - r[i][j] * r[i][j] < kParallelSquared) continue;
      const double along = t[i2] * r[i1][j] - t[i1] * r[i2][j];
      const double reach =
          (ha[i1] * abs_r[i2][j] + ha[i2] * abs_r[i1][j]) + (hb[j1] * abs_r[i][j2] + hb[j2] * abs_r[i][j1]);
      if (std::fabs(along) - reach > noise.edge) return Feature::edge_edge;
    }
  }
  return Feature::none;
}

}  // namespace

OrientedBox carried_box(const Aabb& box, const std::array<double, 16>* matrix, double pad) {
  static constexpr std::array<double, 16> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const std::array<double, 16>& m = matrix ? *matrix : kIdentity;
  const Vec3 column[3] = {{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}};
  OrientedBox carried;
  carried.turned = !(along_one_axis(column[0]) && along_one_axis(column[1]) && along_one_axis(column[2]));
  double stretch[3];
  for (int axis = 0; axis < 3; ++axis) {
    stretch[axis] = scaled_norm(column[axis]);
    const Vec3 c = column[axis];
    carried.axis[axis] = {c.x / stretch[axis], c.y / stretch[axis], c.z / stretch[axis]};
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double cosine = dot(carried.axis[axis], carried.axis[(axis + 1) % 3]);
    if (!(std::fabs(cosine) <= kOrthogonality)) return carried;
  }
  carried.is_box = true;
  const Vec3 middle = box.min * 0.5 + box.max * 0.5, half = box.max * 0.5 - box.min * 0.5;
  carried.centre = {m[0] * middle.x + m[1] * middle.y + m[2] * middle.z + m[3],
                    m[4] * middle.x + m[5] * middle.y + m[6] * middle.z + m[7],
                    m[8] * middle.x + m[9] * middle.y + m[10] * middle.z + m[11]};
  const Vec3 placed{half.x * stretch[0], half.y * stretch[1], half.z * stretch[2]};
  const double radius = norm(placed);
  double largest = 0;  // of the terms of the centre
  for (int row = 0; row < 3; ++row) {
    const double terms[4] = {m[4 * row] * middle.x, m[4 * row + 1] * middle.y, m[4 * row + 2] * middle.z,
                             m[4 * row + 3]};
    for (const double term : terms) largest = std::fmax(largest, std::fabs(term));
  }
  pad += chain_rounding(largest + radius) + 4 * kOrthogonality * radius;
  carried.half = {placed.x + pad, placed.y + pad, placed.z + pad};
  return carried;
}

Feature separating_feature(const OrientedBox& a, const OrientedBox& b) {
  if (!comes_after(a, b)) return separating_axis(a, b);
  const Feature axis = separating_axis(b, a);
  return axis == Feature::face_a ? Feature::face_b : axis == Feature::face_b ? Feature::face_a : axis;
}

}  // namespace satcheck
