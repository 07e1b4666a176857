// E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A Fast Procedure for Computing the Distance Between
// Complex Objects in Three-Dimensional Space" (1988); the duality gap as the stop: G. van den
// Bergen, "Collision Detection in Interactive 3D Environments" (2003), 4.3.
//
//   v <- some point of A - B
//   repeat: w <- the point of A - B farthest against v
//           w.v / |v| bounds the distance from below, |v| from above: stop when they meet
//           v <- closest point to the origin of the hull of the simplex and w
//           drop the vertices that do not carry v
//
// Each round comes strictly closer or ends, so there is no iteration cap.

#include "convex/gjk.hpp"

#include "base/rounding.hpp"

namespace satcheck {

namespace {

Vec3 first_direction(const MinkowskiDifference& m) {
  const Vec3 towards_b = m.b_in_a.translation;
  return norm_squared(towards_b) > 0 ? towards_b : Vec3{1, 0, 0};
}

}  // namespace

SATCHECK_WIDE GjkResult gjk(const MinkowskiDifference& m) {
  const double noise = m.support_error();
  GjkResult result(m.support(first_direction(m)));
  Simplex& simplex = result.simplex;
  const double gap = m.curved ? kCurvedGap * m.scale : 4 * kUnitRoundoff * m.scale;
  while (result.upper > noise) {
    const SupportPoint w = m.support(-result.v);
    const Vec3 axis = result.v * (1 / result.upper);
    ++result.iterations;
    const double lower = dot(axis, w.w);
    if (lower > result.lower) {
      result.lower = lower;
      result.axis = axis;
    }
    if (result.upper - result.lower <= gap || simplex.contains(w)) break;
    simplex.add(w);
    const SupportPoint* p = simplex.vertex;
    const ClosestPoint closest = closest_point<true>(p[0].w, p[1].w, p[2].w, p[3].w, simplex.count);
    if (closest.encloses()) {
      simplex.weight[3] = 0;  // the best point so far; it is the answer if the rest is rounding noise
      normalize_weights(simplex);
      result.v = {0, 0, 0};
      result.status = GjkResult::Status::encloses;
      return result;
    }
    const double distance = std::sqrt(closest.distance_squared);
    if (!(distance < result.upper)) {
      --simplex.count;
      break;
    }
    keep(simplex, closest);
    result.v = closest.v;
    result.upper = distance;
  }
  normalize_weights(simplex);
  result.status = result.lower > noise ? GjkResult::Status::separated : GjkResult::Status::contact;
  return result;
}

}  // namespace satcheck
