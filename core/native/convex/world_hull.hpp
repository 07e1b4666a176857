// The core of a placed shape for exact arithmetic.
#pragma once

#include "convex/shape.hpp"

namespace satcheck {

// Whether a shape is a hull with faces that is not moved. It is then its own world hull.
bool is_in_place(const Shape& shape, const Pose& pose);

// The hull of the world vertices, each rounded by the pose. For polytopes, spheres (their centre) and capsules (their
// axis). A hull in place is not copied, so the shape must outlive this.
class WorldHull {
 public:
  WorldHull(const Shape& shape, const Pose& pose);
  WorldHull(const WorldHull&) = delete;
  WorldHull& operator=(const WorldHull&) = delete;

  // The vertices are relative to the origin of the shape.
  const Polytope& relative() const { return in_place_ ? *in_place_ : moved_; }
  // Not rounded.
  Vec3 vertex(std::size_t i) const { return relative().vertices[i] + origin_; }
  // A copy with its vertices in the world.
  Polytope polytope() const;

 private:
  const Polytope* in_place_ = nullptr;
  Polytope moved_;
  Vec3 origin_;
};

}  // namespace satcheck
