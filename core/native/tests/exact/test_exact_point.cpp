// Dyadic arithmetic against integers, and exact points against points that float64 can hold.
#include "exact/exact_point.hpp"

#include <random>

#include "exact/predicates.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

void arithmetic_matches_integers() {
  std::mt19937_64 generator(1);
  std::uniform_int_distribution<long long> number(-(1LL << 30), 1LL << 30);
  for (int i = 0; i < 20000; ++i) {
    const long long a = number(generator), b = number(generator), c = number(generator) % 1000;
    const Dyadic da = static_cast<double>(a), db = static_cast<double>(b), dc = static_cast<double>(c);
    CHECK((da * db - static_cast<double>(a * b / 4096 * 4096) - static_cast<double>(a * b % 4096)).sign() == 0);
    CHECK((da + db).sign() == (a + b > 0) - (a + b < 0));
    CHECK(((da + dc) * (da - dc) - da * da + dc * dc).sign() == 0);
    if (b != 0) {
      const double truth = static_cast<double>(a) / static_cast<double>(b);
      CHECK(std::fabs(rounded_ratio(da, db) - truth) <= 4.5e-16 * std::fabs(truth));
    }
  }
}

void far_apart_exponents() {
  const Dyadic big = 0x1p+900, small = 0x1p-900;
  CHECK((big + small - big - small).sign() == 0);
  CHECK((big + small - big).sign() == 1);
  CHECK(rounded_ratio(big * big + small, big * big) == 1);
  CHECK(rounded_ratio(-small, big) == 0);
  CHECK(rounded_ratio((big + small) * small, small) == 0x1p+900);
  CHECK(Dyadic(5e-324).sign() == 1);
}

void thirds_lie_in_their_plane() {
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&] { return Vec3{coordinate(generator), coordinate(generator), coordinate(generator)}; };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = point(), b = point(), c = point(), d = point();
    const ExactPoint p = weighted_point(a, b, c, 1, 1, 1);
    CHECK(orientation(a, b, c, p) == 0);
    CHECK(orientation(a, b, c, weighted_point(d, d, d, 1, 2, 4)) == orientation(a, b, c, d));
    CHECK(orientation(a, b, c, weighted_point(a, b, d, 1e30, 1e30, 1e-30)) == orientation(a, b, c, d));
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(orientation_2d_at(a, b, p, axis) == orientation_2d(a, b, c, axis));
      CHECK(orientation_2d_at(a, b, weighted_point(a, b, b, 1, 1, 1), axis) == 0);
    }
    CHECK(max_abs(p.rounded - (a + b + c) * (1.0 / 3)) < 1e-15);
  }
}

// The signs are those of the exact points, whether float64 can tell them or not.
void lazy_points_have_the_signs_of_exact_ones() {
  std::mt19937 generator(3);
  std::uniform_int_distribution<int> coarse(-3, 3);
  std::uniform_real_distribution<double> fine(-1, 1);
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto point = [&] {
      if (i % 2 == 0) return Vec3{coarse(generator) * 0.1, coarse(generator) * 0.1, coarse(generator) * 0.1};
      return Vec3{fine(generator), fine(generator), fine(generator)};
    };
    const std::array<Vec3, 3> t{point(), point(), point()};
    const Vec3 p = point(), q = point(), u = point(), v = point(), w = point();
    const auto agree = [&](const LazyPoint& lazy, const ExactPoint& exact) {
      CHECK(lazy.exact() == exact);
      for (const auto& [a, b, c] : {t, std::array<Vec3, 3>{u, v, w}, std::array<Vec3, 3>{t[0], u, v}}) {
        CHECK(orientation(a, b, c, lazy) == orientation(a, b, c, exact));
        CHECK(orientation_2d_at(a, b, lazy, 1) == orientation_2d_at(a, b, exact, 1));
        const bool inside = orientation(a, b, c, exact) == 0 && !collinear(a, b, c) && plane_point_in_triangle(exact, a, b, c);
        CHECK(point_in_triangle(lazy, a, b, c) == inside && point_in_triangle(exact, a, b, c) == inside);
      }
      CHECK(meet(point_box(lazy), point_box(exact)));
    };
    agree(lazy_centroid(t), weighted_point(t[0], t[1], t[2], 1, 1, 1));
    const int side_p = orientation(t[0], t[1], t[2], p), side_q = orientation(t[0], t[1], t[2], q);
    if (side_p == 0 || side_q == side_p) continue;
    ++met;
    const LazyPoint lazy = lazy_meeting_point(t, p, q), middle = lazy_centroid(t);
    const ExactPoint exact = plane_meeting_point(t[0], t[1], t[2], p, q);
    agree(lazy, exact);
    agree(lazy_between(lazy, middle, 1, 3), between(exact, middle.exact(), 1, 3));
  }
  CHECK(met > 1000);
}

}  // namespace

UNIT(exact_point) {
  arithmetic_matches_integers();
  far_apart_exponents();
  thirds_lie_in_their_plane();
  lazy_points_have_the_signs_of_exact_ones();
}
