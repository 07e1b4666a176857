// A hull that is not moved is its own world hull. Other hulls are computed again, because rounding bends their faces.
#include "convex/convex_hull.hpp"
#include "convex/world_hull.hpp"

namespace satcheck {

Polytope world_hull(const Shape& shape, const Pose& pose) {
  if (shape.kind == ShapeKind::sphere) return convex_hull({pose.translation});
  if (shape.kind == ShapeKind::capsule) return convex_hull({pose * Vec3{0, 0, -shape.size.z}, pose * Vec3{0, 0, shape.size.z}});
  Polytope hull = shape.polytope;
  for (Vec3& p : hull.vertices) p = pose * (p + shape.origin);
  const bool in_place = pose.rotation == Mat3{} && pose.translation == Vec3{};
  return in_place && shape.has_faces ? hull : convex_hull(hull.vertices);
}

}  // namespace satcheck
