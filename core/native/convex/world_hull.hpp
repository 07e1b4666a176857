// The core of a placed shape for exact arithmetic.
#pragma once

#include <optional>

#include "convex/shape.hpp"

namespace satcheck {

// Whether a shape is a polytope that is not moved. It is then its own world hull.
bool is_in_place(const Shape& shape, const Pose& pose);

// The vertices of the core in the world, each rounded by the pose. Of a sphere the centre, of a capsule the ends of its
// axis. Not for other curved shapes.
std::vector<Vec3> world_points(const Shape& shape, const Pose& pose);

// Their hull, for a polytope. A polytope in place is not copied, so the shape must outlive this.
class WorldHull {
 public:
  WorldHull(const Shape& shape, const Pose& pose);
  WorldHull(const WorldHull&) = delete;
  WorldHull& operator=(const WorldHull&) = delete;

  // A hull in place, with faces.
  const Shape& shape() const { return moved_ ? *moved_ : *in_place_; }
  // In the world, not rounded.
  Vec3 vertex(std::size_t i) const { return shape().polytope.vertices[i] + shape().origin; }
  std::vector<Vec3> vertices() const;  // in the world

 private:
  const Shape* in_place_ = nullptr;
  std::optional<Shape> moved_;
};

}  // namespace satcheck
