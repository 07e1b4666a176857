#include "convex/minkowski.hpp"

#include "exact/double_double.hpp"

namespace satcheck {

namespace {

bool has_only_vertices(const Shape& shape) {
  return shape.is_polytope() || shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule;
}

// (b - a) + (d - c) with one rounding of the result, even if large terms cancel.
double sum_of_differences(double a, double b, double c, double d) {
  const DoubleDouble p = exact_sum(b, -a), q = exact_sum(d, -c), sum = exact_sum(p.high, q.high);
  return sum.high + (sum.low + (p.low + q.low));
}

}  // namespace

Vec3 offset_between(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const Vec3 origin_a = pose_a.rotation * a.origin, origin_b = pose_b.rotation * b.origin;
  const Vec3 &ta = pose_a.translation, &tb = pose_b.translation;
  return {sum_of_differences(ta.x, tb.x, origin_a.x, origin_b.x), sum_of_differences(ta.y, tb.y, origin_a.y, origin_b.y),
          sum_of_differences(ta.z, tb.z, origin_a.z, origin_b.z)};
}

MinkowskiDifference::MinkowskiDifference(const Shape& shape_a, const Pose& pose_a, const Shape& shape_b,
                                         const Pose& pose_b)
    : a(shape_a),
      b(shape_b),
      map_a(shape_a.support_map.for_query(shape_a.polytope.vertices)),
      map_b(shape_b.support_map.for_query(shape_b.polytope.vertices)),
      curved(!has_only_vertices(shape_a) || !has_only_vertices(shape_b)) {
  const Mat3& ra = pose_a.rotation;
  const Mat3& rb = pose_b.rotation;
  const Vec3 columns[3] = {{rb.row[0].x, rb.row[1].x, rb.row[2].x},
                           {rb.row[0].y, rb.row[1].y, rb.row[2].y},
                           {rb.row[0].z, rb.row[1].z, rb.row[2].z}};
  const Vec3 cx = transpose_times(ra, columns[0]), cy = transpose_times(ra, columns[1]),
             cz = transpose_times(ra, columns[2]);
  b_in_a.rotation = {{{cx.x, cy.x, cz.x}, {cx.y, cy.y, cz.y}, {cx.z, cy.z, cz.z}}};
  b_in_a.translation = transpose_times(ra, offset_between(a, pose_a, b, pose_b));
  scale = a.extent + a.margin + b.extent + b.margin + max_abs(b_in_a.translation);
}

Pose core_placement(const Shape& shape, const Pose& pose) {
  return {pose.rotation, pose.rotation * shape.origin + pose.translation};
}

}  // namespace satcheck
