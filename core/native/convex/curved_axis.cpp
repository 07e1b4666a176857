// Newton's method on the support function h of A - B over the unit sphere.
//
// h is convex and homogeneous of degree 1, and its gradient is the support point w(n) (R. T. Rockafellar, "Convex
// Analysis", 1970, section 25). Let u be perpendicular to n. At (n + u) / |n + u|, the gradient of the value is the
// tangential part of w, and its Hessian is dw/du - h. The Hessian is approximated by forward differences. A step that
// does not lower the value ends the search, so creases of h do no harm. The creases that matter come from flat faces
// and from the straight lines of a mantle. Their normals are candidates.

#include "convex/curved_axis.hpp"

#include "base/rounding.hpp"

namespace satcheck {

namespace {

struct Tangent {
  Vec3 u, v;  // unit, perpendicular to the axis and each other
};

Tangent tangent_plane(Vec3 axis) {
  const Vec3 u = any_perpendicular(axis);
  return {u, cross(axis, u)};
}

SATCHECK_WIDE AxisSupport support_along(const MinkowskiDifference& m, Vec3 direction) {
  const Vec3 axis = direction * (1 / norm(direction));
  const SupportPoint point = m.support(axis);
  return {axis, point, dot(axis, point.w)};
}

// The outward normal of the flat face that points most along `direction`; (0, 0, 0) if there is none.
Vec3 nearest_flat_normal(const Shape& shape, Vec3 direction) {
  if (shape.kind == ShapeKind::cylinder) return {0, 0, direction.z >= 0 ? 1.0 : -1.0};
  if (shape.kind == ShapeKind::cone) return {0, 0, -1};
  Vec3 nearest{0, 0, 0};
  double most = 0;
  for (const Vec3 normal : shape.polytope.face_normal) {
    if (dot(normal, direction) <= most) continue;
    most = dot(normal, direction);
    nearest = normal;
  }
  return nearest;
}

// The normal along a straight line of the mantle, at the azimuth of `direction`; (0, 0, 0) if there is none.
Vec3 nearest_mantle_normal(const Shape& shape, Vec3 direction) {
  const double across = scaled_norm({direction.x, direction.y, 0});
  if (across == 0) return {0, 0, 0};
  if (shape.kind == ShapeKind::cylinder) return {direction.x, direction.y, 0};
  if (shape.kind != ShapeKind::cone) return {0, 0, 0};
  // The slant goes outward by the radius and down by two half heights. The normal is perpendicular to it.
  const double out = 2 * shape.size.z / across;
  return {direction.x * out, direction.y * out, shape.size.x};
}

void offer(const MinkowskiDifference& m, Vec3 direction, AxisSupport& best) {
  if (norm_squared(direction) == 0) return;
  const AxisSupport candidate = support_along(m, direction);
  if (candidate.value < best.value) best = candidate;
}

using Crease = Vec3 (*)(const Shape&, Vec3);

void offer_crease(const MinkowskiDifference& m, Crease crease, Vec3 axis, AxisSupport& best) {
  const Vec3 against = transpose_times(m.b_in_a.rotation, -axis);
  offer(m, crease(m.a, axis), best);
  offer(m, -(m.b_in_a.rotation * crease(m.b, against)), best);
}

}  // namespace

AxisSupport least_support_near(const MinkowskiDifference& m, Vec3 axis) {
  AxisSupport best = support_along(m, axis);
  offer_crease(m, nearest_flat_normal, axis, best);
  offer_crease(m, nearest_mantle_normal, axis, best);
  for (int step = 0; step < kPolishSteps; ++step) {
    const Tangent t = tangent_plane(best.axis);
    const Vec3 w = best.point.w;
    const Vec3 along_u = (m.support(best.axis + t.u * kPolishAngle).w - w) * (1 / kPolishAngle);
    const Vec3 along_v = (m.support(best.axis + t.v * kPolishAngle).w - w) * (1 / kPolishAngle);
    const double uu = dot(along_u, t.u) - best.value, vv = dot(along_v, t.v) - best.value;
    const double uv = (dot(along_u, t.v) + dot(along_v, t.u)) / 2;
    const double gu = dot(w, t.u), gv = dot(w, t.v), determinant = uu * vv - uv * uv;
    if (!(determinant > 0) || !(uu > 0)) break;  // the value has no minimum nearby
    const Vec3 turn = t.u * ((uv * gv - vv * gu) / determinant) + t.v * ((uv * gu - uu * gv) / determinant);
    AxisSupport next = support_along(m, best.axis + turn);
    offer_crease(m, nearest_mantle_normal, next.axis, next);
    if (!(next.value < best.value)) break;
    best = next;
  }
  return best;
}

}  // namespace satcheck
