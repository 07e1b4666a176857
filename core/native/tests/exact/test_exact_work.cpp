// Exact arithmetic is charged to the budget that is handed down, and more of it where numbers are longer; a sign that
// float64 can tell costs nothing.
#include "base/budget.hpp"

#include <cmath>
#include <random>

#include "exact/exact_point.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

template <class Task>
std::uint64_t work_of(Task task) {
  Budget budget;
  task(&budget);
  return budget.spent();
}

// Of the fourth corner of a parallelogram in a plane that is this steep: which side it lies on, and where it meets a triangle.
std::uint64_t work_in_plane(double slope) {
  const Vec3 a{0, 0, 0}, b{1, 0, slope}, c{0, 1, slope}, d{1, 1, 2 * slope};
  const std::uint64_t of_sign = work_of([&](Budget* budget) { orientation(a, b, c, d, budget); });
  const Corners low{a, b, c}, high{Vec3{2, 0, 2 * slope}, Vec3{0, 2, 2 * slope}, Vec3{2, 2, 4 * slope}};
  const std::uint64_t of_pair = work_of([&](Budget* budget) { classify(low, high, budget); });
  CHECK(of_sign > 100);
  CHECK(of_pair >= 3 * of_sign);
  return of_sign;
}

void test_signs() {
  const Vec3 a{0, 0, 0}, b{1, 0, 0.1}, c{0, 1, 0.3}, beside{0.25, 0.5, 1}, near{0.1, 0.7, 0.1 * 0.1 + 0.7 * 0.3};
  CHECK(work_of([&](Budget* budget) { orientation(a, b, c, beside, budget); }) == 0);
  CHECK(work_of([&](Budget* budget) { orientation(a, b, c, near, budget); }) > 100);
  CHECK(work_in_plane(1e-250) > 2 * work_in_plane(1e-100));
  CHECK(work_in_plane(1e-100) > work_in_plane(0.1));
}

// Of the fourth corner of a parallelogram whose coordinates have exponents up to this one.
std::uint64_t work_with_exponents(int most) {
  std::mt19937 generator(3);
  const auto coordinate = [&] {
    return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(generator), std::uniform_int_distribution<int>(-most, most)(generator));
  };
  std::uint64_t work = 0;
  for (int k = 0; k < 1000; ++k) {
    Vec3 p[3];
    for (Vec3& corner : p) corner = {coordinate(), coordinate(), coordinate()};
    work += work_of([&](Budget* budget) { orientation(p[0], p[1], p[2], p[1] + p[2] - p[0], budget); });
  }
  return work;
}

// Expansions have more terms.
void test_signs_of_mixed_exponents() { CHECK(work_with_exponents(140) > 2 * work_with_exponents(0)); }

// Float64 decides, but slowly: the triangles lie in one plane, or their planes do not separate them.
void test_near_triangles() {
  const Corners low{Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}}, beside{Vec3{5, 0, 0}, Vec3{9, 0, 0}, Vec3{5, 4, 0}};
  const Corners through{Vec3{1, 1, -1}, Vec3{1, 1, 1}, Vec3{1, 2, 1}}, above{Vec3{0, 0, 1}, Vec3{4, 0, 1}, Vec3{0, 4, 1}};
  const auto work_with = [&](const Corners& other) { return work_of([&](Budget* budget) { classify(low, other, budget); }); };
  CHECK(work_with(above) == 0);
  CHECK(work_with(through) > 0);
  CHECK(work_with(beside) > work_with(through));
}

void test_signs_in_a_plane() {
  const auto works = [](Vec3 a, Vec3 b, Vec3 c) {
    const std::uint64_t of_sign = work_of([&](Budget* budget) { orientation_2d(a, b, c, 2, budget); });
    const std::uint64_t of_line = work_of([&](Budget* budget) { collinear(a, b, c, budget); });
    CHECK(of_line >= of_sign);
    CHECK((of_sign == 0) == (work_of([&](Budget* budget) { rounded_normal(a, b, c, budget); }) == 0));
    return of_sign;
  };
  CHECK(works({0, 0, 0}, {1, 0.1, 0}, {0.25, 0.5, 0}) == 0);
  const auto on_a_line = [&](double slope) { return works({0, 0, 0}, {0.7, 0.7 * slope, 0.7 * slope}, {2.1, 2.1 * slope, 2.1 * slope}); };
  CHECK(on_a_line(0.1) > 0);
  CHECK(on_a_line(1e-250) > on_a_line(0.1));
  // Triangles in one plane, whose edges cross: only the plane signs are costly.
  const Corners low{Vec3{0, 0, 0}, Vec3{0.7, 0.07, 0}, Vec3{0, 1, 0}}, on_edge{Vec3{1.4, 0.14, 0}, Vec3{2.1, 0.21, 0}, Vec3{2, 2, 0}};
  CHECK(work_of([&](Budget* budget) { share_area(low, on_edge, 2, budget); }) > 0);
}

void test_points() {
  const auto sign_with = [](double height) {
    const Vec3 a{0, 0, 0}, b{1, 0, height}, c{0, 1, 0.3};
    const ExactPoint third = weighted_point(a, b, c, 1, 1, 1);
    return work_of([&](Budget* budget) { CHECK(orientation(a, b, c, third, budget) == 0); });
  };
  CHECK(sign_with(0.1) > 100);
  CHECK(sign_with(1e-250) > 2 * sign_with(0.1));
}

}  // namespace

UNIT(exact_work) {
  test_signs();
  test_signs_of_mixed_exponents();
  test_near_triangles();
  test_signs_in_a_plane();
  test_points();
}
