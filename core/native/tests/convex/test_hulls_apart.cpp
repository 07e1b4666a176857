// Against the hulls themselves: the same answer, a lower bound of a distance that holds and is not far off, and the depth.
#include "convex/hulls_apart.hpp"

#include <vector>

#include "base/rounding.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

std::vector<Vec3> moved(std::vector<Vec3> points, Vec3 by) {
  for (Vec3& p : points) p = p + by;
  return points;
}

double largest_of(const std::vector<Vec3>& points) {
  double largest = 0;
  for (const Vec3& p : points) largest = std::fmax(largest, max_abs(p));
  return largest;
}

void compare(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  const auto found = check_hulls_of(a, b, std::fmax(largest_of(a), largest_of(b)), Query::distance);
  const PairResult truth = check_pair(make_hull(a), {}, make_hull(b), {}, Query::distance);
  CHECK(found);
  if (!found) return;
  CHECK((found->outcome == Outcome::separated) == (truth.outcome == Outcome::separated));
  if (truth.outcome != Outcome::separated) return;
  CHECK(found->has_distance && found->lower <= truth.upper && found->upper >= truth.lower);
  CHECK(found->lower >= 0.99 * truth.lower);
}

void compare_depth(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  const double largest = std::fmax(largest_of(a), largest_of(b));
  const auto found = check_hulls_of(a, b, largest, Query::depth);
  const PairResult truth = check_pair(make_hull(a), {}, make_hull(b), {}, Query::depth);
  CHECK(found);
  if (!found) return;
  CHECK(found->outcome == truth.outcome && found->lower <= truth.upper && found->upper >= truth.lower);
  CHECK(found->upper - found->lower <= kWidestInterval * largest);
}

void random_balls() {
  testing::Source source(5);
  const std::vector<Vec3> a = source.sphere_points(3000), b = source.sphere_points(2000);
  for (const double apart : {0.0, 1.5, 1.97, 2.03, 2.5, 9.0}) {
    for (int k = 0; k < testing::rounds(10); ++k) {
      const std::vector<Vec3> there = moved(b, source.on_sphere() * apart);
      compare(a, there);
      if (apart > 0) compare_depth(a, there);
    }
  }
}

void depth_of_flat_sets() {
  const std::vector<Vec3> square{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  compare_depth(square, moved(square, {0, 0, 1}));
  CHECK(!check_hulls_of(square, moved(square, {1, 0, 0}), 3, Query::depth));  // they touch
}

void flat_and_few_points() {
  const std::vector<Vec3> point{{0, 0, 0}}, square{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  compare(point, square);
  compare(square, moved(square, {0, 0, 1e-9}));
  compare(square, moved(square, {0.5, 0.5, 0}));
  compare(square, moved(square, {1, 1, 0}));
}

void a_gap_below_rounding_is_left_open() {
  const std::vector<Vec3> square{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  CHECK(!check_hulls_of(square, moved(square, {0, 0, 1e-20}), 2, Query::distance));
}

}  // namespace

UNIT(hulls_apart) {
  random_balls();
  flat_and_few_points();
  depth_of_flat_sets();
  a_gap_below_rounding_is_left_open();
}
