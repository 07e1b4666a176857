// The products of edges are not scaled to unit length, because the rounding of a projection does not shrink with it.
#include "ladder/oriented_box.hpp"

#include <algorithm>
#include <bit>

#include "base/rounding.hpp"
#include "convex/box_axes.hpp"

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

Mat3 to_world(const OrientedBox& box) {
  const Vec3 x = box.axis[0], y = box.axis[1], z = box.axis[2];
  return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}

int first_of(int bits) { return std::countr_zero(static_cast<unsigned>(bits)); }

SATCHECK_WIDE SeparatingAxis axis_between(const OrientedBox& a, const OrientedBox& b) {
  const Vec3 offset = b.centre - a.centre;
  const Noise noise = noise_of(a, b, offset);
  const PlacedBoxes boxes = placed_boxes(to_world(a), a.half, to_world(b), b.half, offset, 0);
  BoxAxes axes;
  measure_faces(boxes, axes);
  const int of_a = bits_of_three(axes.overlap[0] < all_lanes(-noise.face));
  if (of_a != 0) return {Feature::face_a, first_of(of_a), -1, 6};
  const int of_b = bits_of_three(axes.overlap[1] < all_lanes(-noise.face));
  if (of_b != 0) return {Feature::face_b, -1, first_of(of_b), 6};
  measure_edges(boxes, axes);
  for (int i = 0; i < 3; ++i) {
    const int apart = bits_of_three(axes.overlap[2 + i] < all_lanes(-noise.edge));
    const int crossed = bits_of_three(axes.length_squared[i] > all_lanes(kParallelSquared));
    if ((apart & crossed) != 0) return {Feature::edge_edge, i, first_of(apart & crossed), 15};
  }
  return {};
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

SeparatingAxis separating_axis(const OrientedBox& a, const OrientedBox& b) {
  if (!comes_after(a, b)) return axis_between(a, b);
  SeparatingAxis axis = axis_between(b, a);
  std::swap(axis.axis_a, axis.axis_b);
  if (axis.feature == Feature::face_a || axis.feature == Feature::face_b) {
    axis.feature = axis.feature == Feature::face_a ? Feature::face_b : Feature::face_a;
  }
  return axis;
}

}  // namespace satcheck
