// Distances against brute force and closed forms; deviation and convexity of known shapes.
#include "mesh/transform.hpp"
#include "mesh_pair/mesh_distance.hpp"

#include <chrono>
#include <random>

#include "exact/predicates.hpp"
#include "exact/triangle_distance.hpp"
#include "mesh/convexity.hpp"
#include "mesh/surface.hpp"
#include "mesh/topology.hpp"
#include "mesh_pair/reach.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

const Mesh unit = box({0, 0, 0}, {1, 1, 1});

// Truth: nested ternary-like refinement over a grid of barycentric coordinates.
double sampled_distance(const Corners& a, const Corners& b) {
  const int n = 24;
  double best = INFINITY;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j) {
      const Vec3 p = (a[0] * i + a[1] * j + a[2] * (n - i - j)) * (1.0 / n);
      best = std::fmin(best, norm(nearest_on_triangle(p, b) - p));
    }
  return best;
}

void triangle_distances() {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto triangle = [&](Vec3 offset) {
    Corners t;
    for (Vec3& p : t) p = Vec3{coordinate(generator), coordinate(generator), coordinate(generator)} + offset;
    return t;
  };
  for (int i = 0; i < testing::rounds(2000); ++i) {
    const Corners a = triangle({}), b = triangle({i % 3 * 1.0, 0, 0});
    const NearestPoints w = triangle_distance(a, b);
    const double distance = std::sqrt(w.distance_squared), sampled = sampled_distance(a, b);
    CHECK(distance <= sampled + 1e-12);
    CHECK(sampled <= distance + 0.1);
    CHECK(std::fabs(norm(w.b - w.a) - distance) < 1e-15);
    CHECK(norm(nearest_on_triangle(w.a, a) - w.a) < 1e-14);
    CHECK(norm(nearest_on_triangle(w.b, b) - w.b) < 1e-14);
    CHECK((distance == 0) == (classify(a, b) != TriangleContact::disjoint));
  }
  const Corners point{Vec3{1, 2, 3}, Vec3{1, 2, 3}, Vec3{1, 2, 3}};
  CHECK(triangle_distance(point, {Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}}).distance_squared == 9);
  // Parallel edges.
  CHECK(triangle_distance({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, -1, 0}},
                          {Vec3{0.25, 2, 0}, Vec3{0.75, 2, 0}, Vec3{0.5, 3, 0}})
            .distance_squared == 4);
}

void mesh_distances() {
  const Surface a = make_surface(unit, true);
  const auto gap = [&](Vec3 low, Vec3 high, double limit = INFINITY) {
    return mesh_distance(a, make_surface(box(low, high), true), limit);
  };
  CHECK(gap({3, 0, 0}, {4, 1, 1}).distance == 2);
  CHECK(gap({4, 5, 0}, {5, 6, 1}).distance == 5);
  CHECK(gap({1, 0, 0}, {2, 1, 1}).distance == 0);
  CHECK(gap({0.5, 0.5, 0.5}, {2, 2, 2}).distance == 0);
  CHECK(gap({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}).distance == 0.25);
  CHECK(std::isinf(gap({3, 0, 0}, {4, 1, 1}, 1.9).distance));
  CHECK(gap({3, 0, 0}, {4, 1, 1}, 2).distance == 2);

  const Mesh ball = uv_sphere(40);
  const Surface s = make_surface(ball, true), t = make_surface(translate(ball, {2.25, 0.125, 0.5}), true);
  double truth = INFINITY;
  for (std::uint32_t i = 0; i < s.mesh.triangles.size(); i += 1) {
    const Corners c = corners(s.mesh, i);
    if (c[0].x < 0.9) continue;
    for (std::uint32_t j = 0; j < t.mesh.triangles.size(); ++j) {
      const Corners d = corners(t.mesh, j);
      if (d[0].x < 1.4) truth = std::fmin(truth, triangle_distance(c, d).distance_squared);
    }
  }
  const MeshDistance found = mesh_distance(s, t, INFINITY);
  CHECK(found.distance == std::sqrt(truth));
  CHECK(norm(found.witness_b - found.witness_a) == found.distance);
  CHECK(mesh_distance(t, s, INFINITY).distance == found.distance);
}

void nearest_points() {
  const Surface s = make_surface(unit, true);
  CHECK(nearest_point(s, {0.5, 0.5, 3}).distance == 2);
  CHECK(nearest_point(s, {0.5, 0.5, 0.75}).point == (Vec3{0.5, 0.5, 1}));
  CHECK(nearest_point(s, {4, 5, 0.5}).distance == 5);
}

void deviations() {
  Budget unlimited;
  const Surface s = make_surface(unit, true);
  const auto of = [&](Vec3 low, Vec3 high) { return deviation(box(low, high), {&s}, 1e-4, 0, unlimited); };
  const auto brackets = [](Deviation d, double truth) {
    return d.lower <= truth && truth <= d.upper && d.upper - d.lower < 1.01e-4;
  };
  CHECK(brackets(of({0, 0, 0}, {1, 1, 1}), 0));
  CHECK(brackets(of({0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}), 0));
  CHECK(brackets(of({0, 0, 0}, {1, 1, 1.25}), 0.25));
  CHECK(brackets(of({-1, -1, -1}, {2, 2, 2}), std::sqrt(3)));
  CHECK(brackets(of({4, 5, 0}, {5, 5.5, 1}), norm({4, 4.5, 0})));

  // A wall without thickness has no inside.
  const Mesh wall{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  CHECK(brackets(deviation(wall, {&s}, 1e-4, 0, unlimited), 0));
  Mesh notch = box({0, 0, 0}, {4, 1, 1});
  append(notch, box({0, 1, 0}, {1, 3, 1}));
  append(notch, box({3, 1, 0}, {4, 3, 1}));
  // The lid over the notch: farthest from the solid in the middle, 1 from both walls.
  const Mesh lid{{{0, 3, 0}, {4, 3, 0}, {4, 3, 1}, {0, 3, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  const Surface notched = make_surface(notch, true);
  CHECK(brackets(deviation(lid, {&notched}, 1e-4, 0, unlimited), 1));
  // Two halves of a box, of which neither contains it.
  const Surface left = make_surface(box({0, 0, 0}, {0.5, 1, 1}), true), right = make_surface(box({0.5, 0, 0}, {1, 1, 0.75}), true);
  const Deviation missing = deviation(unit, {&left, &right}, 1e-4, 0, unlimited);
  CHECK(brackets(missing, 0.25));
  CHECK(missing.narrow && missing.point.z == 1);
}

void convexity() {
  CHECK(convexity_defect(unit, 0) == 0);
  CHECK(convexity_defect(uv_sphere(2), 0) == 0);  // octahedron
  const double rounded = convexity_defect(uv_sphere(30), 1e-9);
  CHECK(rounded >= 0 && rounded < 1e-11);
  CHECK(std::isinf(convexity_defect(reversed(unit), 1)));
  Mesh layers = unit;  // its faces twice outward and once inward: the same solid
  append(layers, unit);
  append(layers, reversed(unit));
  CHECK(convexity_defect(layers, 0) == 0);
  Mesh open = unit;
  open.triangles.pop_back();
  CHECK(std::isinf(convexity_defect(open, 1)));

  Mesh dented = unit;
  dented.vertices.push_back({0.5, 0.5, 0.75});
  dented.triangles.erase(dented.triangles.begin() + 2, dented.triangles.begin() + 4);
  for (const auto& [u, v] : {std::pair<std::uint32_t, std::uint32_t>{4, 5}, {5, 7}, {7, 6}, {6, 4}}) {
    dented.triangles.push_back({u, v, 8});
  }
  CHECK(measure_topology(dented).solid);
  const double dent = convexity_defect(dented, 1);
  CHECK(dent >= 0.25 && dent < 0.5);
  CHECK(std::isinf(convexity_defect(dented, 0.2)) && std::isinf(convexity_defect(dented, 0)));

  Mesh shell = box({0, 0, 0}, {8, 8, 8});
  append(shell, reversed(box({0.25, 0.25, 0.25}, {7.75, 7.75, 7.75})));
  CHECK(std::isinf(convexity_defect(shell, 1)));
  Mesh small_cavity = box({0, 0, 0}, {8, 8, 8});
  append(small_cavity, reversed(box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75})));
  const double cavity = convexity_defect(small_cavity, 2);
  CHECK(cavity >= 0.75 && cavity < 1.5);

  // Every triangle of an L cut from a thin plate is within 0.01 of a plane of the hull.
  Mesh plate;
  for (const double z : {0.0, 0.01}) {
    for (const auto& [x, y] : {std::pair<double, double>{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}) {
      plate.vertices.push_back({x, y, z});
    }
  }
  plate.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 5, 4}, {6, 7, 8}, {6, 8, 9}, {6, 9, 10}, {6, 10, 11}};
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t k = (i + 1) % 6;
    plate.triangles.push_back({i, k, k + 6});
    plate.triangles.push_back({i, k + 6, i + 6});
  }
  CHECK(measure_topology(plate).solid);
  CHECK(std::isinf(convexity_defect(plate, 0.02)));

  // A slender bar with a corner that rounding pushed in: the bound is of the size of the push.
  Mesh bar = box({0, 0, 0}, {100, 0.1, 0.1});
  bar.vertices.push_back({50, 0.05, 0.1 - 1e-9});
  bar.triangles.erase(bar.triangles.begin() + 2, bar.triangles.begin() + 4);
  for (const auto& [u, v] : {std::pair<std::uint32_t, std::uint32_t>{4, 5}, {5, 7}, {7, 6}, {6, 4}}) {
    bar.triangles.push_back({u, v, 8});
  }
  const double pushed = convexity_defect(bar, 1e-6);
  CHECK(pushed >= 1e-9 && pushed < 4.1e-9);
  Mesh twice = unit;
  append(twice, unit);
  CHECK(convexity_defect(twice, 0) == 0);
}

void large_meshes() {
  const auto start = std::chrono::steady_clock::now();
  const double defect = convexity_defect(uv_sphere(160), 1e-9);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  std::printf("convexity of 101760 triangles: %g in %.3f s\n", defect, elapsed.count());
  CHECK(defect < 1e-11);
}

}  // namespace

UNIT(mesh_distance) {
  triangle_distances();
  mesh_distances();
  nearest_points();
  deviations();
  convexity();
  large_meshes();
}
