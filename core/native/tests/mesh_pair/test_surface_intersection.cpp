// Boxes whose contact is known; what Python tests against oracles runs here under the sanitizers.
#include "mesh_pair/surface_intersection.hpp"

#include <cmath>

#include "mesh_pair/covers_once.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;

namespace {

constexpr std::size_t kPlenty = 1'000'000;

Surface box(Vec3 low, Vec3 high) { return make_surface(testing::box(low, high), true); }

SurfaceIntersection meet_boxes(Vec3 low, Vec3 high) {
  return surface_intersection(box({0, 0, 0}, {2, 2, 2}), box(low, high), kPlenty);
}

void crossing() {
  const SurfaceIntersection found = meet_boxes({1, 0.5, 0.25}, {3, 3, 3});
  CHECK(found.curves.size() == 1 && found.patches.empty() && found.points.empty());
  CHECK(found.curves[0].closed && found.curves[0].points.size() == 6);
  CHECK(found.curves[0].length == 2 * (1 + 1.5 + 1.75));
}

void flush() {
  const SurfaceIntersection found = meet_boxes({2, 0.5, 0.5}, {3, 1.5, 1.5});
  CHECK(found.patches.size() == 1 && found.curves.empty() && found.points.empty());
  CHECK(found.patches[0].opposed && found.patches[0].area == 1);
  CHECK((found.patches[0].normal == Vec3{1, 0, 0}));
}

void edge_and_corner() {
  const SurfaceIntersection edge = meet_boxes({2, 2, 0.5}, {3, 3, 1.5});
  CHECK(edge.curves.size() == 1 && !edge.curves[0].closed && edge.curves[0].length == 1);
  const SurfaceIntersection corner = meet_boxes({2, 2, 2}, {3, 3, 3});
  CHECK(corner.points.size() == 1 && (corner.points[0] == Vec3{2, 2, 2}));
}

void spheres_cross_in_one_loop() {
  Mesh other = testing::uv_sphere(24);
  for (Vec3& p : other.vertices) p = {p.z + 0.7, p.x + 0.1, p.y + 0.2};
  const Surface a = make_surface(testing::uv_sphere(24), true), b = make_surface(other, true);
  const SurfaceIntersection found = surface_intersection(a, b, kPlenty);
  CHECK(found.curves.size() == 1 && found.curves[0].closed && found.points.empty());
  for (Vec3 p : found.curves[0].points) CHECK(norm(p) <= 1 + 1e-15 && norm(p) > 0.99);
  CHECK(!surface_intersection(a, b, 3).complete && surface_intersection(a, b, 3).within_budget);
  Budget few = Budget::that_stops(100'000, {});
  const SurfaceIntersection spent = surface_intersection(a, b, kPlenty, &few);
  CHECK(!spent.complete && !spent.within_budget && spent.curves.empty() && spent.triangle_pairs.empty());
}

// At the ends of the numeric range nothing overflows, underflows or turns into NaN.
void any_scale() {
  for (const double scale : {1e-60, 1e-20, 1e20, 1e40}) {
    const Surface a = box({0, 0, 0}, {2 * scale, 2 * scale, 2 * scale});
    const Surface b = box({2 * scale, scale, scale}, {3 * scale, 3 * scale, 3 * scale});
    const SurfaceIntersection found = surface_intersection(a, b, kPlenty);
    CHECK(found.patches.size() == 1);
    CHECK((found.patches[0].normal == Vec3{1, 0, 0}));
    CHECK(std::fabs(found.patches[0].area / scale / scale - 1) < 1e-14);
  }
}

void covered_once_or_twice() {
  Mesh two = testing::box({0, 0, 0}, {4, 4, 4});
  testing::append(two, testing::reversed(testing::box({1, 1, 1}, {2, 2, 2})));
  CHECK(covers_once(make_surface(two, true)));
  testing::append(two, testing::box({3, 3, 3}, {5, 5, 5}));
  CHECK(!covers_once(make_surface(two, true)));
}

}  // namespace

UNIT(surface_intersection) {
  crossing();
  flush();
  edge_and_corner();
  spheres_cross_in_one_loop();
  any_scale();
  covered_once_or_twice();
}
