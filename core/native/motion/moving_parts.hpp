// The placed parts that motion bounds apply to: boxes, triangles and shapes.
#pragma once

#include "convex/minkowski.hpp"
#include "mesh/surface.hpp"
#include "motion/moving.hpp"

namespace satcheck {

// A box of the tree, placed.
class PlacedBox {
 public:
  PlacedBox(const Aabb& box, const Pose& pose)
      : rotation_(pose.rotation),
        centre_(pose * (box.min * 0.5 + box.max * 0.5)),
        half_(box.max * 0.5 - box.min * 0.5),
        radius_(norm(half_)) {}

  Extent along(Vec3 n) const {
    const Vec3 m = transpose_times(rotation_, n);
    const double middle = dot(n, centre_);
    const double reach = std::fabs(m.x) * half_.x + std::fabs(m.y) * half_.y + std::fabs(m.z) * half_.z;
    return {middle - reach, middle + reach};
  }
  double turning(const Moving& moving) const {
    return norm(cross(moving.spin, centre_ - moving.centre)) + norm(moving.spin) * radius_;
  }
  bool has_corners() const { return true; }
  template <class Visit>
  void each_corner(Visit&& visit) const {
    for (int k = 0; k < 8; ++k) {
      visit(centre_ + axis(0) * (k & 1 ? half_.x : -half_.x) + axis(1) * (k & 2 ? half_.y : -half_.y) +
            axis(2) * (k & 4 ? half_.z : -half_.z));
    }
  }
  Vec3 axis(int k) const { return {rotation_.row[0][k], rotation_.row[1][k], rotation_.row[2][k]}; }
  Vec3 centre() const { return centre_; }

 private:
  const Mat3& rotation_;
  Vec3 centre_, half_;  // world; along the axes of the body
  double radius_;
};

struct PlacedTriangle {
  std::array<Vec3, 3> corners;

  PlacedTriangle(const Surface& surface, std::uint32_t triangle, const Pose& pose)
      : corners(satcheck::corners(surface.mesh, triangle)) {
    for (Vec3& p : corners) p = pose * p;
  }

  Extent along(Vec3 n) const {
    const double x = dot(n, corners[0]), y = dot(n, corners[1]), z = dot(n, corners[2]);
    return {std::fmin(x, std::fmin(y, z)), std::fmax(x, std::fmax(y, z))};
  }
  double turning(const Moving& moving) const {
    double largest = 0;
    for (const Vec3& p : corners) largest = std::fmax(largest, norm(cross(moving.spin, p - moving.centre)));
    return largest;
  }
  bool has_corners() const { return true; }
  template <class Visit>
  void each_corner(Visit&& visit) const {
    for (const Vec3& p : corners) visit(p);
  }
  Vec3 centre() const { return (corners[0] + corners[1] + corners[2]) * (1.0 / 3); }
  Vec3 edge(int k) const { return corners[(k + 1) % 3] - corners[k]; }
  Vec3 normal() const { return cross(corners[1] - corners[0], corners[2] - corners[0]); }
};

// A shape, placed, with the box about it in its own frame.
class PlacedShape {
 public:
  PlacedShape(const Shape& shape, const Pose& pose) : shape_(shape), core_(core_placement(shape, pose)) {
    Vec3 high{support({1, 0, 0}), support({0, 1, 0}), support({0, 0, 1})};
    Vec3 low{-support({-1, 0, 0}), -support({0, -1, 0}), -support({0, 0, -1})};
    centre_ = core_ * ((low + high) * 0.5);
    radius_ = norm(high - low) * 0.5;
  }

  Extent along(Vec3 n) const {
    const Vec3 m = transpose_times(core_.rotation, n);
    const double middle = dot(n, core_.translation), margin = shape_.margin * norm(n);
    return {middle + dot(m, core_support(shape_, -m).point) - margin,
            middle + dot(m, core_support(shape_, m).point) + margin};
  }
  double turning(const Moving& moving) const {
    return norm(cross(moving.spin, centre_ - moving.centre)) + norm(moving.spin) * radius_;
  }
  bool has_corners() const { return shape_.kind == ShapeKind::hull; }
  template <class Visit>
  void each_corner(Visit&& visit) const {
    const VertexLanes& v = shape_.lanes;
    for (std::size_t k = 0; k < v.padded(); ++k) visit(core_ * Vec3{v.x[k], v.y[k], v.z[k]});
  }
  Vec3 centre() const { return centre_; }
  const Shape& shape() const { return shape_; }

 private:
  double support(Vec3 m) const { return dot(m, core_support(shape_, m).point) + shape_.margin; }

  const Shape& shape_;
  Pose core_;
  Vec3 centre_;
  double radius_;
};

// The axis, turned round where it points against the direction.
inline Vec3 towards(Vec3 axis, Vec3 direction) { return dot(axis, direction) < 0 ? -axis : axis; }

// The component of a direction perpendicular to the relative motion of two points, world.
inline Vec3 across_motion(Vec3 direction, const Views& views, Vec3 on_a, Vec3 on_b) {
  const Vec3 v = views.world().a.velocity_at(on_a) - views.world().b.velocity_at(on_b);
  const double squared = norm_squared(v);
  return squared > 0 ? direction - v * (dot(direction, v) / squared) : Vec3{};
}

}  // namespace satcheck
