// Boxes: 3 + 3 face normals and 9 edge pairs, three axes at a time. Deviations from the customary code:
//
// - No constant is added to |R| and no face is preferred beyond rounding: the least overlap is the least
//   overlap.
// - Edge axes count however short their cross product e x b is. Along it, the reach of B's other edges
//   b' is taken from the minors (e x b) . b', not from entries of R that equal them for a true rotation:
//   every term is then as small as the cross product, and dividing by its length costs no digits. The
//   result is exact to rounding for the box whose edges are the columns of R as computed, and that one lies
//   within rounding of B. Only where the cross product is 0 are these edges parallel, and span no facet.

#include <cmath>

#include "base/lanes.hpp"
#include "base/tolerances.hpp"
#include "convex/sat.hpp"

namespace satcheck {

namespace {

// Reach less distance along each axis; > 0 where the boxes overlap on it. Lane k is axis k of three.
struct BoxAxes {
  Lanes of_a, of_b;  // along the face normals
  // Along the cross product of edge i of A and edge k of B, times its length; and that length squared.
  Lanes of_edges[3], length_squared[3];
};

SATCHECK_INLINE Lanes three(double x, double y, double z) { return Lanes{x, y, z, 0}; }
SATCHECK_INLINE Lanes next_lane(Lanes v) { return shuffle<1, 2, 0, 3>(v); }  // lane k takes lane k + 1 of three

SATCHECK_INLINE void measure_faces(const MinkowskiDifference& m, BoxAxes& axes) {
  const Mat3& r = m.b_in_a.rotation;
  const Vec3 t = m.b_in_a.translation, ha = m.a.size, hb = m.b.size;
  const Lanes row0 = three(r.row[0].x, r.row[0].y, r.row[0].z), row1 = three(r.row[1].x, r.row[1].y, r.row[1].z),
              row2 = three(r.row[2].x, r.row[2].y, r.row[2].z);
  const Lanes column0 = three(r.row[0].x, r.row[1].x, r.row[2].x), column1 = three(r.row[0].y, r.row[1].y, r.row[2].y),
              column2 = three(r.row[0].z, r.row[1].z, r.row[2].z);
  // The fourth lane overlaps by far.
  axes.of_a = Lanes{ha.x, ha.y, ha.z, INFINITY} + (abs(column0) * hb.x + abs(column1) * hb.y + abs(column2) * hb.z) -
              abs(three(t.x, t.y, t.z));
  axes.of_b = Lanes{hb.x, hb.y, hb.z, INFINITY} + (abs(row0) * ha.x + abs(row1) * ha.y + abs(row2) * ha.z) -
              abs(row0 * t.x + row1 * t.y + row2 * t.z);
}

SATCHECK_INLINE void measure_edges(const MinkowskiDifference& m, BoxAxes& axes) {
  const Vec3 t = m.b_in_a.translation, ha = m.a.size, hb = m.b.size;
  const Lanes next_half = three(hb.y, hb.z, hb.x), last_half = three(hb.z, hb.x, hb.y);
  Lanes row[3];
  for (int i = 0; i < 3; ++i) {
    const Vec3 r = m.b_in_a.rotation.row[i];
    row[i] = three(r.x, r.y, r.z);
  }
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    const Lanes p = row[i1], q = row[i2];
    const Lanes minor = abs(p * next_lane(q) - next_lane(p) * q);  // |(e_i x b_k) . b_(k+1)|
    const Lanes reach = abs(q) * ha[i1] + abs(p) * ha[i2] + (next_half * minor + last_half * shuffle<2, 0, 1, 3>(minor));
    axes.of_edges[i] = reach - abs(p * t[i2] - q * t[i1]);
    axes.length_squared[i] = p * p + q * q;
  }
}

SATCHECK_INLINE Lanes signed_square(Lanes v) { return v * abs(v); }

}  // namespace

SATCHECK_WIDE BoxSides sides_of_boxes(const MinkowskiDifference& m, double noise) {
  BoxSides result;
  BoxAxes axes;
  measure_faces(m, axes);
  const Lanes none = all_lanes(-noise), some = all_lanes(noise);
  if (const int a = bits_of(axes.of_a < none), b = bits_of(axes.of_b < none); (a | b) != 0) {
    result.side = -1;
    result.axes_tested = 6;
    result.feature = a != 0 ? Feature::face_a : Feature::face_b;
    const int bits = a != 0 ? a : b;
    const std::uint32_t index = bits & 1 ? 0 : bits & 2 ? 1 : 2;
    (a != 0 ? result.index_a : result.index_b) = index;
    return result;
  }
  measure_edges(m, axes);
  result.axes_tested = 15;
  // Against noise times the length, squared: of parallel edges that is 0 against 0, and in nobody's way.
  const Lanes limit = all_lanes(noise * noise);
  int open = bits_of(axes.of_a < some) | bits_of(axes.of_b < some);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Lanes overlap = signed_square(axes.of_edges[i]), short_of = limit * axes.length_squared[i];
    open |= bits_of(overlap < short_of);
    if (const int apart = bits_of(overlap < -short_of); apart != 0) {
      result.side = -1;
      result.feature = Feature::edge_edge;
      result.index_a = i;
      result.index_b = apart & 1 ? 0 : apart & 2 ? 1 : 2;
      return result;
    }
  }
  result.side = open == 0 ? 1 : 0;
  return result;
}

SATCHECK_WIDE SatResult sat_boxes(const MinkowskiDifference& m) {
  const Mat3& r = m.b_in_a.rotation;
  const Vec3 t = m.b_in_a.translation;
  const double tie = kVisible * m.scale;
  BoxAxes axes;
  measure_faces(m, axes);
  measure_edges(m, axes);
  SatResult best;
  best.axes_tested = 15;
  std::uint32_t face = 0;
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (axes.of_a[i] < best.penetration) best.penetration = axes.of_a[face = i];
  }
  best.feature = Feature::face_a;
  best.index_a = face;
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (!(axes.of_b[k] < best.penetration - tie)) continue;
    best.penetration = axes.of_b[k];
    best.feature = Feature::face_b;
    best.index_a = Shape::kNoIndex;
    best.index_b = k;
  }
  double length = 1;
  for (std::uint32_t i = 0; i < 3; ++i) {
    // No cross product is longer than 1: what is not less before the division is not less after it.
    if ((bits_of(axes.of_edges[i] < all_lanes(best.penetration)) & 7) == 0) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const double squared = axes.length_squared[i][k];
      if (!(axes.of_edges[i][k] < best.penetration) || squared == 0) continue;
      const double overlap = axes.of_edges[i][k] / std::sqrt(squared);
      if (!(overlap < best.penetration - tie)) continue;
      best.penetration = overlap;
      length = std::sqrt(squared);
      best.feature = Feature::edge_edge;
      best.index_a = i;
      best.index_b = k;
    }
  }
  best.lower = best.penetration - tie;
  const auto unit = [](std::uint32_t i) { return Vec3{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}; };
  const auto edge_of_b = [&](std::uint32_t k) { return r * unit(k); };
  best.axis = best.feature == Feature::face_a   ? unit(best.index_a)
              : best.feature == Feature::face_b ? edge_of_b(best.index_b)
                                                : cross(unit(best.index_a), edge_of_b(best.index_b)) * (1 / length);
  if (dot(t, best.axis) < 0) best.axis = Vec3{} - best.axis;
  return best;
}

}  // namespace satcheck
