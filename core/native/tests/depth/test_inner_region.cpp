// Regions lie inside their solids, as far as exact winding numbers can see, and are not needlessly small.
#include "convex/convex_hull.hpp"
#include "depth/inner_region.hpp"

#include <random>

#include "mesh/topology.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

double volume(const InnerRegion& region) {
  const Polytope hull = convex_hull(region.vertices);
  return measure_topology({hull.vertices, hull.triangles}).volume;
}

// No random point of the region is outside of the solid.
bool lies_inside(const InnerRegion& region, const Surface& solid) {
  std::mt19937 random(7);
  for (int sample = 0; sample < 2000; ++sample) {
    if (winding_number(solid, random_in_hull(random, region.vertices)) == 0) return false;
  }
  return true;
}

// An L of two arms, 2 thick and 4 high: the notch is x > 2, y > 2.
Mesh bracket() {
  const double outline[6][2] = {{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 6}, {0, 6}};
  Mesh mesh;
  for (const double z : {0.0, 4.0}) {
    for (const auto& p : outline) mesh.vertices.push_back({p[0], p[1], z});
  }
  for (std::uint32_t k = 0; k < 6; ++k) {
    const std::uint32_t next = (k + 1) % 6;
    mesh.triangles.push_back({k, next, next + 6});
    mesh.triangles.push_back({k, next + 6, k + 6});
  }
  for (const Triangle t : {Triangle{3, 2, 1}, {3, 1, 0}, {5, 4, 3}, {5, 3, 0}}) {
    mesh.triangles.push_back(t);
    mesh.triangles.push_back({t[0] + 6, t[2] + 6, t[1] + 6});
  }
  return mesh;
}

void boxes_are_filled() {
  for (const double scale : {1.0, 1e-30, 1e30}) {
    const Surface solid = make_surface(box({0, 0, 0}, Vec3{1, 2, 3} * scale), true);
    const auto region = grow_inner_region(solid, Vec3{0.25, 0.5, 0.125} * scale, {});
    CHECK(region.has_value());
    CHECK(region && volume(*region) > 6 * scale * scale * scale * (1 - 1e-10));
    CHECK(region && lies_inside(*region, solid));
  }
}

void an_arm_is_filled() {
  const Surface solid = make_surface(bracket(), true);
  for (const Vec3 seed : {Vec3{1, 1, 1}, {5, 1, 3}, {1, 5.5, 2}, {1.9, 1.9, 2}, {2.5, 1.75, 3.5}}) {
    const auto round = grow_inner_region(solid, seed, {});
    CHECK(round && lies_inside(*round, solid));
    if (!round) continue;
    const auto spread = grow_inner_region(solid, seed, metric_of(round->vertices));
    CHECK(spread && lies_inside(*spread, solid));
    // The whole corner block at least: planes that give way take a little of it.
    CHECK(volume(*round) > 12);
  }
}

void a_region_stays_within_a_solid() {
  const Surface solid = make_surface(bracket(), true);
  const Mesh around = box({0.5, 0.25, 0.5}, {9, 9, 1.5});  // it reaches out of the bracket
  const Polytope within = convex_hull(around.vertices);
  for (const Vec3 seed : {Vec3{1, 1, 1}, {5, 1, 1}, {1, 5.5, 1}}) {
    const auto region = grow_inner_region(solid, seed, {}, nullptr, &within);
    CHECK(region && lies_inside(*region, solid));
    for (const Vec3& p : region ? region->vertices : std::vector<Vec3>{}) {
      CHECK(p.x > 0.5 - 1e-12 && p.y > 0.25 - 1e-12 && p.z > 0.5 - 1e-12 && p.z < 1.5 + 1e-12);
    }
  }
  CHECK(!grow_inner_region(solid, {0.25, 0.125, 0.25}, {}, nullptr, &within));
}

void round_and_hollow_solids() {
  Mesh shell = box({-3, -3, -3}, {3, 3, 3});
  append(shell, reversed(uv_sphere(12)));
  const Surface hollow = make_surface(shell, true), ball = make_surface(uv_sphere(24), true);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-3, 3);
  int grown = 0;
  for (int k = 0; k < 40; ++k) {
    const Vec3 seed{coordinate(random), coordinate(random), coordinate(random)};
    const auto region = grow_inner_region(hollow, seed, {});
    CHECK(region.has_value() == (winding_number(hollow, seed).value_or(0) != 0));
    if (!region) continue;
    ++grown;
    CHECK(lies_inside(*region, hollow));
  }
  CHECK(grown > 20);
  const auto middle = grow_inner_region(ball, {0.01, 0.02, 0.03}, {});
  CHECK(middle && lies_inside(*middle, ball));
  CHECK(middle && volume(*middle) > 0.5 * measure_topology(ball.mesh).volume);
}

void seeds_that_are_not_inside_have_no_region() {
  const Surface solid = make_surface(bracket(), true);
  for (const Vec3 seed : {Vec3{3, 3, 1}, {-1, 1, 1}, {0, 1, 1}, {2, 2, 2}, {1, 1, 1e-16}}) {
    CHECK(!grow_inner_region(solid, seed, {}));
  }
}

}  // namespace

UNIT(inner_region) {
  boxes_are_filled();
  an_arm_is_filled();
  a_region_stays_within_a_solid();
  round_and_hollow_solids();
  seeds_that_are_not_inside_have_no_region();
}
