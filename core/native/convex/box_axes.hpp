// Boxes: 3 + 3 face normals and 9 edge pairs, three axes at a time. Deviations from the customary code:
//
// - No constant is added to |R|, and faces are preferred only within rounding. The result is the true least overlap.
// - Edge axes count even if their cross product e x b is short. The reach of B's other edges b' along it comes from the
//   minors (e x b) . b', and not from the entries of R that equal them for a true rotation. Every term is then as small
//   as the cross product, so dividing by its length loses no digits. The result is exact up to rounding for the box
//   whose edges are the computed columns of R, and this box is within rounding of B. Edges count as parallel only if
//   float64 can hardly hold their squared cross product. They are then parallel far within rounding and span no facet.
// - No branch depends on coordinates. The processor cannot predict which axis is least, and a wrong prediction costs as
//   much as all nine edge pairs.
//
// Files that include this header compile its inlined functions for wide registers.
#pragma once

#include <bit>
#include <cmath>

#include "base/lanes.hpp"
#include "base/rounding.hpp"
#include "convex/sat.hpp"

namespace satcheck {

// Lane k of three is coordinate k, or axis k. Lane 3 is 0 unless stated otherwise.
SATCHECK_INLINE Lanes three(Vec3 v) { return Lanes{v.x, v.y, v.z, 0}; }
SATCHECK_INLINE Lanes next_lane(Lanes v) { return shuffle<1, 2, 0, 3>(v); }  // lane k takes lane k + 1 of three
SATCHECK_INLINE Lanes last_lane(Lanes v) { return shuffle<2, 0, 1, 3>(v); }  // lane k takes lane k - 1 of three
SATCHECK_INLINE int bits_of_three(LaneMask mask) { return bits_of(mask) & 7; }
SATCHECK_INLINE double least_of_three(Lanes v) { return smaller(smaller(v[0], v[1]), v[2]); }
SATCHECK_INLINE Lanes combine(const Lanes (&of)[3], Lanes by) { return of[0] * by[0] + of[1] * by[1] + of[2] * by[2]; }
SATCHECK_INLINE Lanes cross(Lanes u, Lanes v) { return next_lane(u) * last_lane(v) - last_lane(u) * next_lane(v); }
SATCHECK_INLINE Lanes unit_lane(int i) {
  static constexpr double units[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  return load_lanes(units[i]);
}

// Rows of a 3x3 matrix.
struct LaneMat3 {
  Lanes row[3];
};
SATCHECK_INLINE LaneMat3 lane_mat3(const Mat3& m) { return {{three(m.row[0]), three(m.row[1]), three(m.row[2])}}; }
SATCHECK_INLINE LaneMat3 transposed(const LaneMat3& m) {
  const Lanes low = shuffle<0, 4, 2, 6>(m.row[0], m.row[1]), high = shuffle<1, 5, 3, 7>(m.row[0], m.row[1]);
  const Lanes third = shuffle<0, 3, 2, 3>(m.row[2]), second = shuffle<1, 3, 3, 3>(m.row[2]);
  return {{shuffle<0, 1, 4, 5>(low, third), shuffle<0, 1, 4, 5>(high, second), shuffle<2, 3, 6, 7>(low, third)}};
}

// Two boxes in the frame of A.
struct PlacedBoxes {
  LaneMat3 b_in_a, a_in_b;  // rotations from B's frame to A's and back
  Lanes offset;             // from A's centre to B's
  Lanes half_a, half_b;
  double scale;             // bounds every coordinate of A - B
};

// to_world: rotations from the frames of the boxes. between: from A's centre to B's, in the world. extents: the sum of
// the largest half extents.
SATCHECK_INLINE PlacedBoxes placed_boxes(const Mat3& a_to_world, Vec3 half_a, const Mat3& b_to_world, Vec3 half_b,
                                         Vec3 between, double extents) {
  const LaneMat3 of_a = lane_mat3(a_to_world), of_b = lane_mat3(b_to_world);
  const Vec3* ra = a_to_world.row;
  PlacedBoxes boxes;
  boxes.b_in_a = {{of_b.row[0] * ra[0].x + of_b.row[1] * ra[1].x + of_b.row[2] * ra[2].x,
                   of_b.row[0] * ra[0].y + of_b.row[1] * ra[1].y + of_b.row[2] * ra[2].y,
                   of_b.row[0] * ra[0].z + of_b.row[1] * ra[1].z + of_b.row[2] * ra[2].z}};
  boxes.a_in_b = transposed(boxes.b_in_a);
  boxes.offset = of_a.row[0] * between.x + of_a.row[1] * between.y + of_a.row[2] * between.z;
  boxes.half_a = three(half_a);
  boxes.half_b = three(half_b);
  const Lanes offset = abs(boxes.offset);
  boxes.scale = extents + larger(offset[0], larger(offset[1], offset[2]));
  return boxes;
}

// 15 axes in five triples: the face normals of A, those of B, and the cross products of edge 0, 1 and 2 of A
// with the three edges of B. Along each axis, times its length: the offset from A's centre to B's, and the overlap of
// the boxes (reach minus distance). Lane 3 is meaningless.
struct BoxAxes {
  Lanes distance[5], overlap[5];
  Lanes length_squared[3];  // of the cross products
};

SATCHECK_INLINE void measure_faces(const PlacedBoxes& boxes, BoxAxes& axes) {
  const Lanes(&row)[3] = boxes.b_in_a.row, (&column)[3] = boxes.a_in_b.row;
  const Lanes t = boxes.offset, ha = boxes.half_a, hb = boxes.half_b;
  axes.distance[0] = t;
  axes.overlap[0] = ha + (abs(column[0]) * hb[0] + abs(column[1]) * hb[1] + abs(column[2]) * hb[2]) - abs(t);
  axes.distance[1] = combine(row, t);
  axes.overlap[1] = hb + (abs(row[0]) * ha[0] + abs(row[1]) * ha[1] + abs(row[2]) * ha[2]) - abs(axes.distance[1]);
}

SATCHECK_INLINE void measure_edges(const PlacedBoxes& boxes, BoxAxes& axes) {
  const Lanes(&row)[3] = boxes.b_in_a.row;
  const Lanes t = boxes.offset, ha = boxes.half_a, hb = boxes.half_b;
  const Lanes next_half = next_lane(hb), last_half = last_lane(hb);
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    const Lanes p = row[i1], q = row[i2];
    const Lanes minor = abs(p * next_lane(q) - next_lane(p) * q);  // |(e_i x b_k) . b_(k+1)|
    const Lanes reach = abs(q) * ha[i1] + abs(p) * ha[i2] + (next_half * minor + last_half * last_lane(minor));
    axes.distance[2 + i] = p * t[i2] - q * t[i1];
    axes.overlap[2 + i] = reach - abs(axes.distance[2 + i]);
    axes.length_squared[i] = p * p + q * q;
  }
}

// Squares of sines that float64 does not hold with all digits. Such edges are parallel far within rounding.
inline constexpr double kParallelEdges = 1e-200;

struct LeastOverlap {
  double penetration;
  double lower;           // no axis has less, up to the rounding of a support value
  int kind;               // 0: a face normal of A; 1: of B; 2: edge of A x edge of B
  int i, k;               // axis of A, axis of B; both the same for a face normal
  Lanes axis, axis_in_b;  // unit, from A to B, in the frame of A and of B
  double inverse_sine;    // of the angle between the edges
};

SATCHECK_INLINE LeastOverlap least_overlap(const PlacedBoxes& boxes) {
  BoxAxes axes;
  measure_faces(boxes, axes);
  measure_edges(boxes, axes);
  Lanes inverse_sine[3], of_edges[3];
  for (int i = 0; i < 3; ++i) {
    inverse_sine[i] = all_lanes(1) / square_root(axes.length_squared[i]);
    of_edges[i] = select(axes.length_squared[i] > all_lanes(kParallelEdges), axes.overlap[2 + i] * inverse_sine[i],
                         all_lanes(INFINITY));
  }
  // From here on, values are selected by index in memory, so that the compiler makes no branch.
  const Lanes least[3] = {axes.overlap[0], axes.overlap[1], smaller(smaller(of_edges[0], of_edges[1]), of_edges[2])};
  const double of_a = least_of_three(least[0]), of_b = least_of_three(least[1]), of_pair = least_of_three(least[2]);
  const double tie = kVisible * boxes.scale;
  const bool by_b = of_b < of_a - tie;
  const double of_face = by_b ? of_b : of_a;
  const bool by_edges = of_pair < of_face - tie;
  LeastOverlap best;
  best.kind = by_edges ? 2 : by_b;
  best.penetration = by_edges ? of_pair : of_face;
  best.lower = best.penetration - tie;
  const int where = bits_of_three(least[best.kind] == all_lanes(best.penetration));
  best.k = std::countr_zero(static_cast<unsigned>(where) | 4u);  // below three even if all are nan
  const bool not_0 = of_edges[0][best.k] != best.penetration, not_1 = of_edges[1][best.k] != best.penetration;
  best.i = by_edges ? not_0 + (not_0 & not_1) : best.k;

  best.inverse_sine = inverse_sine[best.i][best.k];
  const Lanes e = unit_lane(best.i), e_in_b = boxes.b_in_a.row[best.i];  // axis i of A
  const Lanes f = boxes.a_in_b.row[best.k], f_in_b = unit_lane(best.k);  // axis k of B
  const Lanes in_a[3] = {e, f, cross(e, f) * best.inverse_sine};
  const Lanes in_b[3] = {e_in_b, f_in_b, cross(e_in_b, f_in_b) * best.inverse_sine};
  const Lanes axis = in_a[best.kind], axis_in_b = in_b[best.kind], zero = all_lanes(0);
  const LaneMask turned = all_lanes(axes.distance[by_edges ? 2 + best.i : best.kind][best.k]) < zero;
  best.axis = select(turned, zero - axis, axis);
  best.axis_in_b = select(turned, zero - axis_in_b, axis_in_b);
  return best;
}

SATCHECK_INLINE Lanes signed_square(Lanes v) { return v * abs(v); }

}  // namespace satcheck
