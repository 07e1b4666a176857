// Hulls that are not moved are used where they are, and hulls that are moved are those of the rounded vertices.
#include <algorithm>

#include "convex/convex_hull.hpp"
#include "convex/shape.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

void test_in_place_far_from_zero() {
  testing::Source source(2);
  std::vector<Vec3> points = source.sphere_points(20);
  for (Vec3& p : points) p = p + Vec3{1000, 0, -3000};
  const Shape shape = make_hull(points);
  CHECK(shape.origin != Vec3{});
  const WorldHull hull(shape, {});
  CHECK(&hull.shape() == &shape);
  for (std::size_t i = 0; i < points.size(); ++i) CHECK(std::find(points.begin(), points.end(), hull.vertex(i)) != points.end());
  CHECK(hull.vertices() == convex_hull(points).vertices);
}

void test_moved() {
  testing::Source source(3);
  const Shape shape = make_hull(source.sphere_points(20));
  const Pose pose = source.pose(5);
  std::vector<Vec3> points = shape.polytope.vertices;
  for (Vec3& p : points) p = pose * p;
  const Polytope expected = convex_hull(points);
  const WorldHull hull(shape, pose);
  CHECK(hull.vertices() == expected.vertices && hull.shape().polytope.face_vertex == expected.face_vertex);
}

void test_cores() {
  Pose pose;
  pose.translation = {1, 2, 3};
  CHECK(world_points(make_sphere(2), pose) == std::vector<Vec3>({{1, 2, 3}}));
  CHECK(world_points(make_capsule(2, 1), {}) == std::vector<Vec3>({{0, 0, -1}, {0, 0, 1}}));
  CHECK(!is_in_place(make_capsule(2, 1), {}));
}

// The faces are computed once, also for a copy.
void test_without_faces() {
  const Shape shape = make_hull_without_faces({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}), copy = shape;
  const WorldHull hull(shape, {});
  CHECK(hull.shape().polytope.face_count() == 4);
  CHECK(&WorldHull(copy, {}).shape() == &hull.shape());
}

}  // namespace

UNIT(world_hull) {
  test_in_place_far_from_zero();
  test_moved();
  test_cores();
  test_without_faces();
}
