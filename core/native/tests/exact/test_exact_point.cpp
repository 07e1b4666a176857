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

}  // namespace

int main() {
  arithmetic_matches_integers();
  far_apart_exponents();
  thirds_lie_in_their_plane();
  return testing::exit_status();
}
