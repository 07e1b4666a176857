// Relations of boxes and spheres, degenerate contacts, evidence, and what is not solid. The lattice
// fuzz against set operations is in tests/core/test_mesh_relation.py.
#include "mesh/transform.hpp"
#include "mesh_pair/mesh_pair.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "exact/predicates.hpp"
#include "mesh/topology.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

const Mesh cube = box({0, 0, 0}, {4, 4, 4});

bool is_free(Relation r) { return r == Relation::separated || r == Relation::touching; }

Relation relate(const Mesh& a, const Mesh& b) {
  const Surface s = make_surface(a, measure_topology(a).solid), t = make_surface(b, measure_topology(b).solid);
  const MeshRelation result = mesh_relation(s, t);
  CHECK(result.proven);
  const MeshRelation overlap = overlap_relation(s, t);
  CHECK(overlap.proven && is_free(overlap.relation) == is_free(result.relation));
  return result.relation;
}

void boxes() {
  CHECK(relate(cube, box({5, 0, 0}, {6, 1, 1})) == Relation::separated);
  CHECK(relate(cube, box({4, 0, 0}, {6, 4, 4})) == Relation::touching);
  CHECK(relate(cube, box({4, 4, 4}, {6, 6, 6})) == Relation::touching);
  CHECK(relate(cube, box({4, 1, 1}, {6, 2, 2})) == Relation::touching);
  CHECK(relate(cube, box({3, 1, 1}, {6, 2, 2})) == Relation::penetrating);
  CHECK(relate(cube, box({3, 0, 0}, {6, 4, 4})) == Relation::penetrating);
  CHECK(relate(cube, box({1, 1, 1}, {2, 2, 2})) == Relation::contains);
  CHECK(relate(box({1, 1, 1}, {2, 2, 2}), cube) == Relation::inside);
  CHECK(relate(cube, box({1, 1, 1}, {2, 2, 4})) == Relation::penetrating);
  CHECK(relate(cube, cube) == Relation::coincident);
}

void several_parts() {
  Mesh two = box({1, 1, 1}, {2, 2, 2});
  append(two, box({9, 9, 9}, {10, 10, 10}));
  CHECK(relate(cube, two) == Relation::penetrating);
  CHECK(relate(two, cube) == Relation::penetrating);
  // A ball around the cavity of a block: no contact, the block does not contain it.
  Mesh block = box({0, 0, 0}, {9, 9, 9});
  append(block, reversed(box({4, 4, 4}, {5, 5, 5})));
  CHECK(relate(block, box({3, 3, 3}, {6, 6, 6})) == Relation::penetrating);
  CHECK(relate(block, box({4.25, 4.25, 4.25}, {4.75, 4.75, 4.75})) == Relation::separated);
}

// Flush boxes in one mesh leave a double wall inside its material.
void double_wall() {
  Mesh pair = box({0, 0, 0}, {2, 2, 2});
  append(pair, box({2, 0, 0}, {4, 2, 2}));
  CHECK(relate(pair, box({2, 0, 0}, {3, 1, 1})) == Relation::penetrating);
  CHECK(relate(pair, box({1, 0.5, 0.5}, {3, 1, 1})) == Relation::contains);
  CHECK(relate(pair, box({1, 2, 0.5}, {3, 3, 1})) == Relation::touching);
}

void spheres() {
  const Mesh ball = uv_sphere(30);
  CHECK(relate(ball, translate(ball, {1.9, 0.1, 0.1})) == Relation::penetrating);
  CHECK(relate(ball, translate(ball, {2.1, 0, 0})) == Relation::separated);
  CHECK(relate(ball, translate(ball, {0, 0, 2})) == Relation::touching);  // poles meet
  CHECK(relate(ball, translate(ball, {0, 0, std::nextafter(2.0, 0.0)})) == Relation::penetrating);
  CHECK(relate(ball, transform(ball, {0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1})) == Relation::contains);
}

void open_surfaces() {
  const Mesh sheet{{{-9, -9, 2}, {9, -9, 2}, {9, 9, 2}, {-9, 9, 2}}, {{0, 1, 2}, {0, 2, 3}}};
  CHECK(relate(cube, sheet) == Relation::penetrating);
  CHECK(relate(cube, translate(sheet, {0, 0, 2})) == Relation::touching);
  CHECK(relate(cube, translate(sheet, {0, 0, 3})) == Relation::separated);
  CHECK(relate(sheet, translate(sheet, {0, 0, 1})) == Relation::separated);
  CHECK(relate(sheet, sheet) == Relation::coincident);
  CHECK(relate(sheet, Mesh{}) == Relation::separated);
  CHECK(relate(Mesh{}, Mesh{}) == Relation::separated);
}

// Two grids of four squares that cross, or fold, along edges of both, of one, or at a corner.
void sheets_that_meet_at_edges() {
  const auto sheet = [](Vec3 u, Vec3 left, Vec3 right) {
    // Two strips joined along the line from -u to u.
    const Vec3 o = -u;
    return Mesh{{o, u, o + left, u + left, o + right, u + right}, {{0, 1, 3}, {0, 3, 2}, {1, 0, 4}, {1, 4, 5}}};
  };
  const Vec3 x{2, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const Mesh flat = sheet(x, y, -y), upright = sheet(x, z, -z), tent = sheet(x, y + z, -y + z);
  CHECK(relate(flat, upright) == Relation::penetrating);
  CHECK(relate(flat, tent) == Relation::touching);
  CHECK(relate(upright, tent) == Relation::penetrating);
  CHECK(relate(upright, sheet(x, y + z, y - z)) == Relation::touching);
  // The joint of one inside a strip of the other.
  CHECK(relate(translate(flat, {0, 0.5, 0}), upright) == Relation::penetrating);
  CHECK(relate(translate(flat, {0, 0.5, 0}), tent) == Relation::touching);
  // Only the border of one: no crossing.
  CHECK(relate(flat, translate(upright, z)) == Relation::touching);
  CHECK(relate(translate(flat, {4, 0, 0}), upright) == Relation::touching);
}

void large_flush_contact() {
  Mesh grid;
  const std::uint32_t n = kSanitized ? 30 : 60;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= n; ++j)
      for (const double z : {0.0, 1.0}) grid.vertices.push_back({i * 1.0, j * 1.0, z});
  const auto at = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) { return 2 * (i * (n + 1) + j) + k; };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      grid.triangles.push_back({at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1)});
      grid.triangles.push_back({at(i, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1)});
      grid.triangles.push_back({at(i, j, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0)});
      grid.triangles.push_back({at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0)});
    }
    for (const auto& [p, q] : {std::pair<std::uint32_t, std::uint32_t>{at(i, 0, 0), at(i + 1, 0, 0)}, {at(i + 1, n, 0), at(i, n, 0)},
                              {at(n, i, 0), at(n, i + 1, 0)}, {at(0, i + 1, 0), at(0, i, 0)}}) {
      grid.triangles.push_back({p, q, q + 1});
      grid.triangles.push_back({p, q + 1, p + 1});
    }
  }
  CHECK(measure_topology(grid).solid);
  const auto start = std::chrono::steady_clock::now();
  CHECK(relate(grid, translate(grid, {0, 0, 1})) == Relation::touching);
  CHECK(relate(grid, translate(grid, {0.25, 0.5, 1})) == Relation::touching);
  CHECK(relate(grid, translate(grid, {0.25, 0, 0})) == Relation::penetrating);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  std::printf("flush plates of %zu triangles: %.3f s\n", grid.triangles.size(), elapsed.count());
}

}  // namespace

UNIT(mesh_pair) {
  boxes();
  several_parts();
  double_wall();
  spheres();
  open_surfaces();
  sheets_that_meet_at_edges();
  large_flush_contact();
}
