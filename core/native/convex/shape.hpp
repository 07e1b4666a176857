// Convex shapes given by their support function.
//
// A sphere and a capsule are a core (a point, a segment) and a margin: the Minkowski sum with a ball, which adds the
// radius to every support value (van den Bergen, "Collision
// Detection in Interactive 3D Environments", 2003, chapter 4).
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "convex/box_frame.hpp"
#include "convex/convex_hull.hpp"
#include "convex/support_map.hpp"

namespace satcheck {

enum class ShapeKind : std::uint8_t { hull, box, sphere, capsule, cylinder, cone, ellipsoid };

// An edge for the separating axis test: its position, and the normals of its two faces.
struct EdgeArc {
  Vec3 tail, direction;  // unit direction
  Vec3 normal_left, normal_right;
};

struct Shape;

// A hull with its faces, made when a query first needs them.
struct LazyFaces {
  std::once_flag once;
  std::shared_ptr<const Shape> hull;
};

struct Shape {
  // The fields that every query reads come first.
  ShapeKind kind = ShapeKind::hull;
  // For a hull. False: the vertices include all extreme points and perhaps others, and there are no faces, edges and
  // arcs (see with_faces).
  bool has_faces = true;
  // Box: half extents. Ellipsoid: radii. Cylinder, cone, capsule: radius in x and y, half height
  // in z. Sphere: radius in x. The axis is the local z; the cone's apex is at +z.
  Vec3 size;
  double margin = 0;  // radius of the ball around the core: sphere and capsule
  Vec3 origin;
  double extent = 0;  // largest |coordinate| of the core, relative to `origin`
  // Two points of the core, usually deep inside it, within 8 roundoffs of the extent. The first is used if the shape is
  // A, the second if it is B. They are not on planes of symmetry, because rays between such points of aligned shapes
  // would graze edges.
  Vec3 inside[2];
  // Hull and box. Coordinates of a hull are relative to `origin`. This moves a hull far from the world's origin to its
  // own origin without rounding.
  VertexLanes lanes;
  LazySupportMap support_map;  // of a hull of many vertices
  Polytope polytope;
  std::vector<EdgeArc> arcs;  // of a solid hull
  VertexLanes face_normals;   // of the polytope
  std::shared_ptr<LazyFaces> lazy_faces;  // of a hull without faces; copies share it
  std::shared_ptr<const BoxFrame> box;  // of a hull that is a box

  bool is_polytope() const { return kind == ShapeKind::hull || kind == ShapeKind::box; }
  bool is_box() const { return kind == ShapeKind::box || box; }
};

// Points (n >= 1) in any order; the shape is their convex hull, computed exactly.
Shape make_hull(const std::vector<Vec3>& points);
Shape make_hull(Polytope polytope);
// The same for three points that are not collinear, without faces.
Shape make_triangle(const std::array<Vec3, 3>& corners);
// The hull of points that span a solid. The faces are not computed.
Shape make_hull_without_faces(std::vector<Vec3> points);
// The same shape, with its faces. They are computed at the first call, from any thread, and live as long as the shape.
const Shape& with_faces(const Shape& shape);
// All sizes are positive and finite, or std::invalid_argument is thrown.
Shape make_box(Vec3 half_extents);
Shape make_sphere(double radius);
Shape make_capsule(double radius, double half_height);
Shape make_cylinder(double radius, double half_height);
Shape make_cone(double radius, double half_height);
Shape make_ellipsoid(Vec3 radii);

// Support point of the core in the local frame.
CorePoint core_support(const Shape& shape, Vec3 direction);
CorePoint round_support(const Shape& shape, Vec3 direction);  // not for hulls and boxes

// core_support() for loops that are compiled for wide registers as a whole.
SATCHECK_INLINE CorePoint inlined_core_support(const Shape& shape, Vec3 d) {
  if (shape.kind == ShapeKind::hull) {
    const std::uint32_t index = support_index(shape.lanes, d);
    return {{shape.lanes.x[index], shape.lanes.y[index], shape.lanes.z[index]}, index};
  }
  if (shape.kind != ShapeKind::box) return round_support(shape, d);
  const Vec3 s = shape.size;
  const unsigned x = d.x >= 0, y = d.y >= 0, z = d.z >= 0;
  return {{x ? s.x : -s.x, y ? s.y : -s.y, z ? s.z : -s.z}, x << 2 | y << 1 | z};
}

// Whether a shape is a polytope that is not moved. It is then its own world hull.
bool is_in_place(const Shape& shape, const Pose& pose);

// The vertices of the core in the world, each rounded by the pose. Of a sphere the centre, of a capsule the ends of its
// axis. Not for other curved shapes.
std::vector<Vec3> world_points(const Shape& shape, const Pose& pose);

// The hull of world_points(), for a polytope: its core for exact arithmetic. Hulls that are moved are computed again,
// because rounding bends their faces. A polytope in place is not copied, so the shape must outlive this.
class WorldHull {
 public:
  WorldHull(const Shape& shape, const Pose& pose);
  WorldHull(const WorldHull&) = delete;
  WorldHull& operator=(const WorldHull&) = delete;

  // A hull in place, with faces. Of a moved one, only the polytope and its face normals are set.
  const Shape& shape() const { return moved_ ? *moved_ : *in_place_; }
  // In the world, not rounded.
  Vec3 vertex(std::size_t i) const { return shape().polytope.vertices[i] + shape().origin; }
  std::vector<Vec3> vertices() const;  // in the world

 private:
  const Shape* in_place_ = nullptr;
  std::optional<Shape> moved_;
};

}  // namespace satcheck
