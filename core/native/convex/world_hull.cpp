// Hulls that are moved are computed again, because rounding bends their faces.
#include "convex/convex_hull.hpp"
#include "convex/world_hull.hpp"

namespace satcheck {

namespace {

Polytope moved_hull(const Shape& shape, const Pose& pose) {
  if (shape.kind == ShapeKind::sphere) return convex_hull({pose.translation});
  if (shape.kind == ShapeKind::capsule) return convex_hull({pose * Vec3{0, 0, -shape.size.z}, pose * Vec3{0, 0, shape.size.z}});
  std::vector<Vec3> vertices = shape.polytope.vertices;
  for (Vec3& p : vertices) p = pose * (p + shape.origin);
  return convex_hull(vertices);
}

}  // namespace

bool is_in_place(const Shape& shape, const Pose& pose) {
  return shape.is_polytope() && pose.rotation == Mat3{} && pose.translation == Vec3{};
}

WorldHull::WorldHull(const Shape& shape, const Pose& pose) {
  if (is_in_place(shape, pose)) {
    in_place_ = &with_faces(shape);
  } else {
    moved_ = make_hull(moved_hull(shape, pose));
  }
}

Polytope WorldHull::polytope() const {
  Polytope hull = shape().polytope;
  for (Vec3& p : hull.vertices) p = p + shape().origin;
  return hull;
}

}  // namespace satcheck
