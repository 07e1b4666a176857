// inspect() against the steps that it stands for, on boxes that are put together and broken.
#include "mesh/inspection.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include "mesh/orient.hpp"
#include "mesh/transform.hpp"
#include "tests/boxes.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

bool same(const Topology& a, const Topology& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles && a.components == b.components &&
         a.boundary_edges == b.boundary_edges && a.nonmanifold_edges == b.nonmanifold_edges &&
         a.misoriented_edges == b.misoriented_edges && a.degenerate_triangles == b.degenerate_triangles &&
         a.duplicate_triangles == b.duplicate_triangles && a.closed == b.closed && a.manifold == b.manifold &&
         a.oriented == b.oriented && a.volume == b.volume && a.solid == b.solid;
}

bool same(const Mesh& a, const Mesh& b) { return a.vertices == b.vertices && a.triangles == b.triangles; }

void check_steps(const Mesh& mesh, bool turned) {
  const Mesh welded = sort(weld(mesh));
  const Topology topology = measure_topology(welded);
  const Inspection plain = inspect(mesh, false);
  CHECK(same(plain.mesh, welded) && same(plain.topology, topology) && !plain.turned);
  const Inspection found = inspect(mesh, true);
  const Mesh expected = orient(welded);
  CHECK(same(found.mesh, expected) && same(found.topology, topology));
  CHECK(found.turned == turned && turned == !same(expected, welded));
  CHECK(same(found.repaired, measure_topology(expected)));
}

Mesh shuffled_soup(const Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  Mesh soup{{{9, 9, 9}}, {}};  // and a vertex that no triangle names
  std::vector<Triangle> left = mesh.triangles;
  while (!left.empty()) {
    std::swap(left[random() % left.size()], left.back());
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : left.back()) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
    left.pop_back();
  }
  return soup;
}

// Rectangles with T-junctions around caves, and along edges with four sheets, are closed, and none is turned.
void check_t_junctions(double filled, unsigned seed) {
  std::mt19937 random(seed);
  const Cells cells = random_cells(random, 4, filled);
  const auto volume = static_cast<double>(std::count(cells.filled.begin(), cells.filled.end(), true));
  if (volume == 0) return;
  const Mesh mesh = shuffled_soup(rectangles_of(cells, random), seed);
  for (const bool inside_out : {false, true}) {
    const Inspection found = with_cracks_closed(inspect(inside_out ? reversed(mesh) : mesh, true), true, 1e-9);
    CHECK(found.repaired.closed && found.repaired.oriented && found.doubtful != found.repaired.solid);
    CHECK(found.repaired.volume == (found.doubtful ? -volume : volume) && (inside_out || !found.doubtful));
    CHECK(found.turned == (inside_out && !found.doubtful) && found.holes.empty() == !found.doubtful);
  }
}

// A few triangles turned, dropped, doubled, corners merged: whatever is measured for less is measured the same.
void check_damaged(const Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  Mesh damaged = mesh;
  const auto some = [&] { return random() % damaged.triangles.size(); };
  for (unsigned k = random() % 3; k > 0; --k) std::swap(damaged.triangles[some()][0], damaged.triangles[some()][1]);
  for (unsigned k = random() % 3; k > 0; --k) {
    Triangle& t = damaged.triangles[some()];
    std::swap(t[0], t[1]);
  }
  if (random() % 3 == 0) damaged.triangles.erase(damaged.triangles.begin() + static_cast<std::ptrdiff_t>(some()));
  if (random() % 3 == 0) damaged.triangles.push_back(damaged.triangles[some()]);
  if (random() % 3 == 0) damaged.vertices[damaged.triangles[some()][0]] = damaged.vertices[damaged.triangles[some()][1]];
  CHECK(same(inspect(damaged, false).topology, measure_topology(sort(weld(damaged)))));
}

}  // namespace

UNIT(inspection) {
  for (unsigned seed = 0; seed < 200; ++seed) check_t_junctions(0.1 + 0.8 * (seed % 9) / 8, seed);
  Mesh touching = uv_sphere(4);  // at a corner
  append(touching, translate(uv_sphere(4), {0, 0, 2}));
  const Mesh pillow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  for (const Mesh& mesh : {uv_sphere(4), touching, pillow, box({0, 0, 0}, {1, 1, 1})}) {
    check_steps(mesh, false);
    for (unsigned seed = 0; seed < 200; ++seed) check_damaged(mesh, seed);
  }
  const Mesh unit = box({-0.0, 0, 0}, {1, 1, 1});
  check_steps(unit, false);
  check_steps(shuffled_soup(unit, 1), false);
  check_steps(reversed(unit), true);
  Mesh two = unit;
  append(two, reversed(box({0.25, 0.25, 0.25}, {0.5, 0.5, 0.5})));  // a cavity
  check_steps(shuffled_soup(two, 2), false);
  append(two, reversed(box({3, 3, 3}, {4, 4, 4})));
  check_steps(shuffled_soup(two, 3), true);
  Mesh open = unit;
  open.triangles.pop_back();
  check_steps(open, false);
  Mesh mixed = unit;
  std::swap(mixed.triangles[3][0], mixed.triangles[3][1]);
  check_steps(shuffled_soup(mixed, 4), true);
}
