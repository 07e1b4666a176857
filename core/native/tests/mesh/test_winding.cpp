// Winding numbers of points in, on and around boxes and spheres.
#include "mesh/winding.hpp"

#include <random>
#include <stdexcept>

#include "exact/exact_point.hpp"
#include "mesh/surface.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

void lattice_points_of_a_box() {
  const Surface s = make_surface(box({0, 0, 0}, {2, 2, 2}), true);
  for (int i = -1; i <= 3; ++i)
    for (int j = -1; j <= 3; ++j)
      for (int k = -1; k <= 3; ++k) {
        const auto inside = [](int c) { return c > 0 && c < 2; };
        const auto beyond = [](int c) { return c < 0 || c > 2; };
        const auto w = winding_number(s, {i * 1.0, j * 1.0, k * 1.0});
        if (beyond(i) || beyond(j) || beyond(k)) {
          CHECK(w == 0);
        } else if (inside(i) && inside(j) && inside(k)) {
          CHECK(w == 1);
        } else {
          CHECK(!w.has_value());
        }
      }
}

void overlapping_and_inverted_shells_add_up() {
  Mesh mesh = box({0, 0, 0}, {4, 4, 4});
  append(mesh, box({1, 1, 1}, {5, 5, 5}));
  append(mesh, reversed(box({2, 2, 2}, {3, 3, 3})));
  append(mesh, Mesh{{{9, 9, 9}, {9, 9, 10}, {9, 9, 11}}, {{0, 1, 2}, {2, 1, 0}}});
  const Surface s = make_surface(mesh, true);
  CHECK(winding_number(s, {0.5, 0.5, 0.5}) == 1);
  CHECK(winding_number(s, {1.5, 1.5, 1.5}) == 2);
  CHECK(winding_number(s, {2.5, 2.5, 2.5}) == 1);
  CHECK(winding_number(s, {4.5, 4.5, 4.5}) == 1);
  CHECK(winding_number(s, {8, 8, 8}) == 0);
}

void points_near_a_sphere() {
  const Surface s = make_surface(uv_sphere(20), true);
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    Vec3 p{normal(generator), normal(generator), normal(generator)};
    p = p * (1 / norm(p));
    CHECK(winding_number(s, p * 0.98) == 1);
    CHECK(winding_number(s, p * 1.000001) == 0);
  }
  for (const Vec3& v : s.mesh.vertices) CHECK(!winding_number(s, v).has_value());
}

// The middle of each triangle, which float64 cannot hold: on the surface, 1 behind it, 0 in front.
void both_sides_of_every_triangle() {
  const Surface s = make_surface(uv_sphere(12), true);
  for (std::uint32_t t = 0; t < s.mesh.triangles.size(); ++t) {
    const auto c = corners(s.mesh, t);
    const ExactPoint p = weighted_point(c[0], c[1], c[2], 1, 1, 1);
    CHECK(!winding_number(s.mesh, s.bvh, p).has_value());
    const auto beside = winding_beside(s.mesh, s.bvh, p, c[0], c[1], c[2]);
    CHECK(beside && beside->front == 0 && beside->back == 1 && beside->on_surface);
    const auto reversed = winding_beside(s.mesh, s.bvh, p, c[0], c[2], c[1]);
    const auto lazily = winding_beside(s.mesh, s.bvh, lazy_centroid(c), c[0], c[1], c[2], t);
    CHECK(lazily && lazily->front == 0 && lazily->back == 1 && lazily->is_boundary());
    CHECK(reversed && reversed->front == 1 && reversed->back == 0 && reversed->is_boundary());
  }
}

void open_surfaces_are_no_solids() {
  Mesh open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  bool refused = false;
  try {
    make_surface(open, true);
  } catch (const std::invalid_argument&) {
    refused = true;
  }
  CHECK(refused);
  CHECK(!make_surface(open, false).solid);
}

}  // namespace

UNIT(winding) {
  lattice_points_of_a_box();
  overlapping_and_inverted_shells_add_up();
  points_near_a_sphere();
  both_sides_of_every_triangle();
  open_surfaces_are_no_solids();
}
