// One coordinate out of range at every place among few and many points.
#include "base/numeric_range.hpp"

#include <limits>
#include <stdexcept>

#include <vector>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

enum class Refusal { none, argument, overflow };

Refusal refusal_of(const std::vector<Vec3>& points) {
  Refusal refusal = Refusal::none;
  try {
    require_in_range(points, "point");
  } catch (const std::invalid_argument&) {
    refusal = Refusal::argument;
  } catch (const std::overflow_error&) {
    refusal = Refusal::overflow;
  }
  CHECK(are_in_range(points) == (refusal == Refusal::none));
  return refusal;
}

void every_place() {
  for (std::size_t count = 1; count < 14; ++count) {
    std::vector<Vec3> points(count, {1, -2, 0});
    CHECK(refusal_of(points) == Refusal::none);
    for (std::size_t i = 0; i < count; ++i) {
      for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
        const double kept = points[i].*axis;
        const auto with = [&](double c) {
          points[i].*axis = c;
          return refusal_of(points);
        };
        for (const double sign : {1.0, -1.0}) {
          CHECK(with(sign * kLargestCoordinate) == Refusal::none);
          CHECK(with(sign * 2 * kLargestCoordinate) == Refusal::overflow);
          // Points that differ by no more than that are too small as a whole.
          const bool differ_by_that = axis == &Vec3::z && count > 1;
          CHECK(with(sign * std::numeric_limits<double>::denorm_min()) == (differ_by_that ? Refusal::overflow : Refusal::none));
          CHECK(with(sign * std::numeric_limits<double>::infinity()) == Refusal::argument);
          CHECK(with(sign * 0.0) == Refusal::none);
        }
        CHECK(with(std::numeric_limits<double>::quiet_NaN()) == Refusal::argument);
        points[i].*axis = kept;
      }
    }
  }
}

void sizes() {
  CHECK(refusal_of({}) == Refusal::none);
  for (std::size_t count = 2; count < 14; ++count) {
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<Vec3> points(count);
      points[i].y = 0.5 * kSmallestSize;
      CHECK(refusal_of(points) == Refusal::overflow);
      points[i].y = kSmallestSize;
      CHECK(refusal_of(points) == Refusal::none);
    }
  }
}

}  // namespace

UNIT(numeric_range) {
  every_place();
  sizes();
}
