#include "convex/convex_hull.hpp"
#include "convex/shape.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "base/numeric_range.hpp"
#include "exact/predicates.hpp"

namespace satcheck {

namespace {
void require_positive(double value, const char* what) {
  if (!(value > 0 && std::isfinite(value))) throw std::invalid_argument(std::string(what) + " must be positive and finite");
  if (value < kSmallestSize || value > kLargestCoordinate) {
    throw std::overflow_error(std::string(what) + " is out of range: it must be between 1e-45 and 1e45");
  }
}

// The middle of the shape along axes on which it is farther from 0 than 1.5 sizes; 0 along the others. All coordinates
// are then within a third of the middle, so subtracting it is exact (P. H. Sterbenz, "Floating-Point Computation",
// 1974).
Vec3 exact_centre(const Aabb& bounds) {
  const Vec3 size = bounds.max - bounds.min, middle = bounds.min + size * 0.5;
  const double far = 1.5 * max_abs(size);
  const auto taken = [&](double coordinate) { return std::fabs(coordinate) > far ? coordinate : 0.0; };
  return {taken(middle.x), taken(middle.y), taken(middle.z)};
}

double largest_coordinate(const std::vector<Vec3>& points) {
  double extent = 0;
  for (Vec3 p : points) extent = std::fmax(extent, max_abs(p));
  return extent;
}

// The points farthest along three skew directions and their opposites.
std::array<Vec3, 6> skew_ends(const std::vector<Vec3>& points) {
  std::array<Vec3, 6> ends;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int i = static_cast<int>(axis);
    const auto height = [&](Vec3 p) { return p[i] - p[(i + 1) % 3] / 4 + p[(i + 2) % 3] / 16; };
    const auto [least, most] =
        std::minmax_element(points.begin(), points.end(), [&](Vec3 p, Vec3 q) { return height(p) < height(q); });
    ends[2 * axis] = *least;
    ends[2 * axis + 1] = *most;
  }
  return ends;
}

Vec3 weighted_mean(const std::array<Vec3, 6>& points, const std::array<double, 6>& weights) {
  Vec3 sum;
  double total = 0;
  for (std::size_t i = 0; i < 6; i += 2) {
    sum = sum + (points[i] * weights[i] + points[i + 1] * weights[i + 1]);
    total += weights[i] + weights[i + 1];
  }
  return sum * (1 / total);
}

// The square of a very short edge underflows.
Vec3 unit_of(Vec3 d) {
  while (max_abs(d) < 0x1p-400) d = d * 0x1p600;
  return d * (1 / norm(d));
}

std::vector<EdgeArc> arcs_of(const Polytope& p) {
  std::vector<EdgeArc> arcs;
  if (p.dimension < 3) return arcs;
  arcs.reserve(p.edges.size());
  for (const PolytopeEdge& e : p.edges) {
    const Vec3 d = p.vertices[e.head] - p.vertices[e.tail];
    arcs.push_back({p.vertices[e.tail], unit_of(d), p.face_normal[e.left], p.face_normal[e.right]});
  }
  return arcs;
}

}  // namespace

Shape make_hull(Polytope polytope) {
  Shape shape;
  shape.kind = ShapeKind::hull;
  shape.origin = exact_centre(bounds_of(polytope.vertices));
  for (Vec3& p : polytope.vertices) p = p - shape.origin;
  shape.polytope = std::move(polytope);
  shape.arcs = arcs_of(shape.polytope);
  shape.lanes = VertexLanes(shape.polytope.vertices);
  shape.face_normals = VertexLanes(shape.polytope.face_normal);
  shape.support_map = LazySupportMap(shape.polytope.vertices.size());
  shape.extent = largest_coordinate(shape.polytope.vertices);
  const std::array<Vec3, 6> ends = skew_ends(shape.polytope.vertices);
  shape.inside[0] = weighted_mean(ends, {11, 13, 17, 22, 19, 30});
  shape.inside[1] = weighted_mean(ends, {29, 12, 15, 21, 13, 25});
  if (const auto box = find_box(shape.polytope.vertices)) shape.box = std::make_shared<BoxFrame>(*box);
  return shape;
}

Shape make_hull(const std::vector<Vec3>& points) { return make_hull(convex_hull(points)); }

Shape make_hull_without_faces(std::vector<Vec3> points) {
  Polytope polytope;
  polytope.dimension = 3;
  polytope.vertices = std::move(points);
  Shape shape = make_hull(std::move(polytope));
  shape.has_faces = false;
  shape.lazy_faces = std::make_shared<LazyFaces>();
  return shape;
}

Shape make_triangle(const std::array<Vec3, 3>& corners) {
  // The order of convex_hull(): counter-clockwise along the axis that is dropped, from the least point on.
  std::array<Vec3, 3> p = corners;
  std::sort(p.begin(), p.end(), coordinates_less);
  const int axis = projection_axis(rounded_normal(p[0], p[2], p[1]));
  const int i = axis == 2 ? 0 : axis + 1, j = axis == 0 ? 2 : axis - 1;
  const auto least = std::min_element(p.begin(), p.end(), [&](Vec3 u, Vec3 v) { return u[i] != v[i] ? u[i] < v[i] : u[j] < v[j]; });
  std::rotate(p.begin(), least, p.end());
  if (orientation_2d(p[0], p[1], p[2], axis) < 0) std::swap(p[1], p[2]);
  return make_hull_without_faces({p.begin(), p.end()});
}

const Shape& with_faces(const Shape& shape) {
  if (shape.has_faces) return shape;
  LazyFaces& faces = *shape.lazy_faces;
  std::call_once(faces.once, [&] {
    std::vector<Vec3> points = shape.polytope.vertices;
    for (Vec3& p : points) p = p + shape.origin;
    faces.hull = std::make_shared<const Shape>(make_hull(points));
  });
  return *faces.hull;
}

Shape make_box(Vec3 half_extents) {
  for (int axis = 0; axis < 3; ++axis) require_positive(half_extents[axis], "a half extent of the box");
  std::vector<Vec3> corners;
  for (double x : {-1.0, 1.0}) {
    for (double y : {-1.0, 1.0}) {
      for (double z : {-1.0, 1.0}) corners.push_back({x * half_extents.x, y * half_extents.y, z * half_extents.z});
    }
  }
  Shape shape = make_hull(corners);
  shape.kind = ShapeKind::box;
  shape.size = half_extents;
  shape.box.reset();
  return shape;
}

namespace {

Shape make_round(ShapeKind kind, Vec3 size, double margin, double extent) {
  Shape shape;
  shape.kind = kind;
  shape.size = size;
  shape.margin = margin;
  shape.extent = extent;
  if (margin == 0) {
    shape.inside[0] = {size.x / 7, size.y / 11, size.z / 13};
    shape.inside[1] = {size.x / -11, size.y / 13, size.z / -7};
  }
  return shape;
}

}  // namespace

Shape make_sphere(double radius) {
  require_positive(radius, "the radius of the sphere");
  return make_round(ShapeKind::sphere, {radius, 0, 0}, radius, 0);
}

Shape make_capsule(double radius, double half_height) {
  require_positive(radius, "the radius of the capsule");
  require_positive(half_height, "the half height of the capsule");
  return make_round(ShapeKind::capsule, {radius, radius, half_height}, radius, half_height);
}

Shape make_cylinder(double radius, double half_height) {
  require_positive(radius, "the radius of the cylinder");
  require_positive(half_height, "the half height of the cylinder");
  return make_round(ShapeKind::cylinder, {radius, radius, half_height}, 0, std::fmax(radius, half_height));
}

Shape make_cone(double radius, double half_height) {
  require_positive(radius, "the radius of the cone");
  require_positive(half_height, "the half height of the cone");
  return make_round(ShapeKind::cone, {radius, radius, half_height}, 0, std::fmax(radius, half_height));
}

Shape make_ellipsoid(Vec3 radii) {
  for (int axis = 0; axis < 3; ++axis) require_positive(radii[axis], "a radius of the ellipsoid");
  return make_round(ShapeKind::ellipsoid, radii, 0, max_abs(radii));
}

namespace {

Vec3 disc_support(double radius, Vec3 direction, double z) {
  const double length = scaled_norm({direction.x, direction.y, 0});
  if (length == 0) return {radius, 0, z};
  return {radius * (direction.x / length), radius * (direction.y / length), z};
}

}  // namespace

SATCHECK_WIDE CorePoint core_support(const Shape& shape, Vec3 d) { return inlined_core_support(shape, d); }

CorePoint round_support(const Shape& shape, Vec3 d) {
  const Vec3 s = shape.size;
  switch (shape.kind) {
    case ShapeKind::hull:
    case ShapeKind::box:
      break;
    case ShapeKind::sphere:
      return {{0, 0, 0}, 0};
    case ShapeKind::capsule:
      return {{0, 0, d.z >= 0 ? s.z : -s.z}, d.z >= 0 ? 1u : 0u};
    case ShapeKind::cylinder:
      return {disc_support(s.x, d, d.z >= 0 ? s.z : -s.z), kNoIndex};
    case ShapeKind::cone: {
      const Vec3 apex{0, 0, s.z}, rim = disc_support(s.x, d, -s.z);
      if (dot(apex, d) >= dot(rim, d)) return {apex, 0};
      return {rim, kNoIndex};
    }
    case ShapeKind::ellipsoid: {
      Vec3 scaled{s.x * d.x, s.y * d.y, s.z * d.z};
      const double largest = max_abs(scaled);
      if (largest == 0) return {{s.x, 0, 0}, kNoIndex};
      scaled = scaled * (1 / largest);  // the direction may have any length, so its square may overflow
      const double length = norm(scaled);
      return {{s.x * (scaled.x / length), s.y * (scaled.y / length), s.z * (scaled.z / length)}, kNoIndex};
    }
  }
  return {{0, 0, 0}, kNoIndex};  // not reached: these have other support functions
}

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
    moved_.emplace().polytope = convex_hull(world_points(shape, pose));
    moved_->face_normals = VertexLanes(moved_->polytope.face_normal);
  }
}

std::vector<Vec3> WorldHull::vertices() const { return world_points(shape(), {}); }

}  // namespace satcheck
