#include <cmath>
#include <numbers>
#include <random>

#include "base/angle.hpp"
#include "base/rounding.hpp"
#include "base/vec.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

constexpr double kPi = std::numbers::pi;
// The functions of the C library are off by a last bit themselves: of pi at most, that is 2 roundoffs.
constexpr double kLibrary = 4 * kUnitRoundoff;

void angles_are_right_to_what_they_promise() {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 200'000; ++k) {
    const double y = unit(random), x = unit(random) * (k % 3 == 0 ? std::exp(40 * unit(random)) : 1);
    CHECK(std::fabs(direction_angle(y, x) - std::atan2(y, x)) <= 16 * kUnitRoundoff + kLibrary);
    const double c = k % 4 == 0 ? std::copysign(1 - std::exp(-36 * std::fabs(x)), y) : y;
    CHECK(std::fabs(angle_of_cosine(c) - std::acos(c)) <= 16 * kUnitRoundoff + kLibrary);
    CHECK(std::fabs(cosine_of(kPi / 2 * std::fabs(y)) - std::cos(kPi / 2 * std::fabs(y))) <= 8 * kUnitRoundoff + kLibrary);
  }
}

void angles_at_the_ends() {
  CHECK(direction_angle(0, 0) == 0);
  CHECK(direction_angle(0, -1) == kPi);
  CHECK(direction_angle(2, 0) == kPi / 2 && direction_angle(-2, 0) == -kPi / 2);
  CHECK(direction_angle(5e-324, 5e-324) == direction_angle(1, 1));
  CHECK(angle_of_cosine(1) == 0 && angle_of_cosine(-1) == kPi);
  CHECK(cosine_of(0) == 1);
}

void norms_of_any_size() {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 100'000; ++k) {
    const double size = std::ldexp(1.0, static_cast<int>(1000 * unit(random)));
    const Vec3 v{size * unit(random), size * unit(random), size * unit(random)};
    const double expected = std::hypot(v.x, v.y, v.z);
    CHECK(std::fabs(scaled_norm(v) - expected) <= 6 * kUnitRoundoff * expected);
  }
  CHECK(scaled_norm({0, 0, 0}) == 0);
  CHECK(scaled_norm({3e-310, 4e-310, 0}) == std::hypot(3e-310, 4e-310));
  CHECK(scaled_norm({INFINITY, 0, 0}) == INFINITY);
}

}  // namespace

UNIT(angle) {
  angles_are_right_to_what_they_promise();
  angles_at_the_ends();
  norms_of_any_size();
}
