// Hulls that are moved are computed again, because rounding bends their faces.
#include "convex/convex_hull.hpp"
#include "convex/world_hull.hpp"

namespace satcheck {

std::vector<Vec3> world_points(const Shape& shape, const Pose& pose) {
  if (shape.kind == ShapeKind::sphere) return {pose.translation};
  if (shape.kind == ShapeKind::capsule) return {pose * Vec3{0, 0, -shape.size.z}, pose * Vec3{0, 0, shape.size.z}};
  std::vector<Vec3> points = shape.polytope.vertices;
  const bool moved = !is_in_place(shape, pose);
  for (Vec3& p : points) p = moved ? pose * (p + shape.origin) : p + shape.origin;
  return points;
}

bool is_in_place(const Shape& shape, const Pose& pose) {
  return shape.is_polytope() && pose.rotation == Mat3{} && pose.translation == Vec3{};
}

WorldHull::WorldHull(const Shape& shape, const Pose& pose) {
  if (is_in_place(shape, pose)) {
    in_place_ = &with_faces(shape);
  } else {
    moved_ = make_hull(world_points(shape, pose));
  }
}

std::vector<Vec3> WorldHull::vertices() const { return world_points(shape(), {}); }

}  // namespace satcheck
