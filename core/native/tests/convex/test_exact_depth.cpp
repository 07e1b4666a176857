// Exact depths: closed forms, ties, and shapes on which float64 loses most digits.
#include <algorithm>

#include "convex/exact_depth.hpp"
#include "convex/narrow_phase.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

using Points = std::vector<Vec3>;

double reach(const Points& points, Vec3 n) {
  double most = -INFINITY;
  for (Vec3 p : points) most = std::fmax(most, dot(n, p));
  return most;
}

// Checks the length, its bounds, the normal, the way out and the witness points; returns the length.
double depth(const Points& a, const Points& b) {
  const ExactFigure f = exact_depth(ExactDifference(a, b));
  CHECK(f.lower <= f.value && f.value <= f.upper);
  CHECK(std::fabs(norm(f.normal) - 1) <= 1e-15);
  double scale = 0;
  for (const Points* points : {&a, &b}) {
    for (Vec3 p : *points) scale = std::fmax(scale, max_abs(p));
  }
  CHECK(f.upper - f.lower <= 1e-14 * scale);
  CHECK(std::fabs(reach(a, f.normal) + reach(b, -f.normal) - f.value) <= 1e-14 * scale);
  CHECK(max_abs(f.witness_b - f.witness_a + f.normal * f.value) <= 1e-14 * scale);
  CHECK(std::fabs(dot(f.witness_a, f.normal) - reach(a, f.normal)) <= 1e-14 * scale);
  CHECK(std::fabs(dot(f.witness_b, -f.normal) - reach(b, -f.normal)) <= 1e-14 * scale);
  return f.value;
}

void test_closed_forms() {
  const Points unit = box_corners({0, 0, 0}, {1, 1, 1});
  CHECK(depth(unit, unit) == 1);
  CHECK(depth(unit, box_corners({0.75, -1, -1}, {2, 2, 2})) == 0.25);
  CHECK(depth(box_corners({-1, -1, -1}, {1, 1, 1}), box_corners({-0.5, -0.25, -0.125}, {0.5, 0.25, 0.125})) == 1.125);
  CHECK(depth({{0, 0, 0}}, box_corners({-1, -2, -3}, {1, 2, 3})) == 1);
  CHECK(depth({{-4, 0, 0}, {4, 0, 0}}, box_corners({-1, -0.5, -2}, {1, 0.5, 2})) == 0.5);
  // A corner cut off the unit simplex: the plane x + y + z = 1 lies 1/4 / sqrt(3) above the corner.
  const Points simplex{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  CHECK(std::fabs(depth(simplex, box_corners({0.25, 0.25, 0.25}, {2, 2, 2})) - 0.25 / std::sqrt(3.0)) <= 1e-16);
}

void test_what_float64_cannot_see() {
  const double ulp = std::ldexp(1, -52), thin = std::ldexp(1, -40);
  CHECK(depth(box_corners({0, 0, 0}, {1, 1, 1}), box_corners({1 - ulp / 2, 0, 0}, {2, 1, 1})) == ulp / 2);
  // Two plates of aspect 1e12 that share half their thickness.
  CHECK(depth(box_corners({-1, -1, 0}, {1, 1, thin}), box_corners({-1, -1, thin / 2}, {1, 1, thin})) == thin / 2);
}

// A flat and its copy an ulp aside: the difference is so thin that several planes have about one distance.
void test_flats_that_nearly_coincide() {
  const double ulp = std::ldexp(1, -52);
  Points a{{0, -2, -3}, {0, 2, 2}, {3, 1, 2}}, b;
  for (Vec3 p : a) b.push_back(p + Vec3{-ulp, ulp, ulp});
  const double there = depth(a, b);
  CHECK(there > 0);
  for (int i = 0; i < 3; ++i) {
    std::rotate(a.begin(), a.begin() + 1, a.end());
    for (int k = 0; k < 3; ++k) {
      std::rotate(b.begin(), b.begin() + 1, b.end());
      CHECK(depth(a, b) == there && depth(b, a) == there);
    }
    std::swap(b[0], b[1]);
  }
}

void test_random_hulls_in_any_order() {
  Source source(11);
  for (int i = 0; i < 50; ++i) {
    const Points a = source.sphere_points(12);
    Points b = source.sphere_points(20);
    for (Vec3& p : b) p = p + Vec3{0.3, 0.2, 0.1};
    const double there = depth(a, b), back = depth(b, a);
    CHECK(there == back);
    CHECK(there == depth(Points(a.rbegin(), a.rend()), b));
  }
}

// A prism of 6,000 sides on a circle.
Points prism_of_many_sides(double size) {
  Points points;
  for (int m = 1; m <= 1500; ++m) {
    const double t = m / 1500.0, x = (1 - t * t) / (1 + t * t), y = 2 * t / (1 + t * t);
    for (const double z : {-1.0, 1.0}) {
      points.insert(points.end(), {{size * x, size * y, z}, {-size * x, size * y, z}, {size * x, -size * y, z}, {-size * x, -size * y, z}});
    }
  }
  return points;
}

// As many facets as sides are almost nearest. All ways out of the round walls are about 1.5 long, through the ends 2.
void test_ends_with_its_steps() {
  const Points outer = prism_of_many_sides(1), inner = prism_of_many_sides(0.5);
  Budget budget = Budget::that_stops(1'000'000);
  bool stopped = false;
  try {
    exact_depth(ExactDifference(outer, inner, &budget));
  } catch (const BudgetSpent&) {
    stopped = true;
  }
  CHECK(stopped);
  const PairResult bounded = check_pair(make_hull(outer), {}, make_hull(inner), {}, Query::depth);
  CHECK(bounded.outcome == Outcome::penetrating);
  CHECK(-1.5 <= bounded.lower + 1e-12 && bounded.lower <= bounded.upper && bounded.upper <= -1.499);
}

}  // namespace

UNIT(exact_depth) {
  test_ends_with_its_steps();
  test_closed_forms();
  test_what_float64_cannot_see();
  test_flats_that_nearly_coincide();
  test_random_hulls_in_any_order();
}
