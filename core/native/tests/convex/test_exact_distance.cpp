// Exact distances: closed forms, and shapes on which float64 loses most digits.
#include "convex/exact_distance.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

using Points = std::vector<Vec3>;

// Checks the length, its bounds, the normal and the witness points; returns the length.
double distance(const Points& a, const Points& b) {
  const ExactFigure f = exact_distance(ExactDifference(a, b));
  CHECK(f.lower <= f.value && f.value <= f.upper);
  CHECK(f.upper - f.lower <= 4e-15 * f.value);
  CHECK(std::fabs(norm(f.normal) - 1) <= 1e-15);
  double scale = 0;
  for (const Points* points : {&a, &b}) {
    for (Vec3 p : *points) scale = std::fmax(scale, max_abs(p));
  }
  CHECK(max_abs(f.witness_b - f.witness_a - f.normal * f.value) <= 4e-15 * scale);
  return f.value;
}

void test_features() {
  const Points unit = box_corners({0, 0, 0}, {1, 1, 1});
  CHECK(distance(unit, box_corners({3, 0, 0}, {4, 1, 1})) == 2);
  CHECK(distance(unit, box_corners({4, 5, 0}, {5, 6, 1})) == 5);
  CHECK(distance(unit, box_corners({3, 3, 2}, {4, 4, 3})) == 3);
  CHECK(distance({{0, 0, 0}}, {{0, 0, 0.5}}) == 0.5);
  CHECK(distance({{-1, 0, 0}, {1, 0, 0}}, {{0, -1, 2}, {0, 1, 2}}) == 2);
  CHECK(distance({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 1, 1}, {1, 1, 9}}) == 1);
}

void test_distances_that_float64_cannot_see() {
  const double ulp = std::ldexp(1, -52);
  CHECK(distance(box_corners({0, 0, 0}, {1, 1, 1}), box_corners({1 + ulp, 0, 0}, {2, 1, 1})) == ulp);
  // A unit gap to a needle 1e9 long that all but touches along its length.
  CHECK(distance({{-1e9, 0, 1}, {1e9, 0, 1}}, {{-1e9, 0, 0}, {1e9, 1e-9, 0}}) == 1);
  CHECK(distance({{1e12, 0, 0}}, {{1e12, std::ldexp(1, -60), 0}}) == std::ldexp(1, -60));
}

void test_distances_in_any_order() {
  Source source(7);
  for (int i = 0; i < 50; ++i) {
    const Points a = source.sphere_points(12);
    Points b = source.sphere_points(20);
    for (Vec3& p : b) p = p + Vec3{2, 1, 0.5};
    const double there = distance(a, b), back = distance(b, a);
    CHECK(there == back);
    CHECK(there == distance(Points(a.rbegin(), a.rend()), b));
  }
}

}  // namespace

UNIT(exact_distance) {
  test_features();
  test_distances_that_float64_cannot_see();
  test_distances_in_any_order();
}
