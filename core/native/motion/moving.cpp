#include "motion/moving.hpp"

#include <numbers>

#include "base/angle.hpp"
#include "base/rounding.hpp"

namespace satcheck {
namespace {

// Rounding of the height of a point, in roundoffs of its distance from the origin and of that of the centre: a dot
// product 4, the axis and the products of `a` and `b` 16 each. Each of the two angles has an error of 16 roundoffs and their
// sum one of 8, and with it the point moves by so many roundoffs of its radius. The cosine of the angle between the top
// of the circle and the height has an error of 8, which is a height of 8 roundoffs of the radius. The radius is at most
// the sum of both distances.
constexpr double kHeightError = 128 * kUnitRoundoff;
// Rounding of the angular velocity: the unit axis 4, the rate 4. The rate of the gap allows for it at the body that
// turns; a body at rest that is seen as turning may be far larger, and the angle is not limited here.
constexpr double kSpinError = 16 * kUnitRoundoff;

// The largest s with room >= rate s + bend s^2 / 2, for room > 0 and bend >= 0.
double time_by_bend(double room, double rate, double bend) {
  if (bend == 0) return rate > 0 ? room / rate : INFINITY;
  const double root = std::sqrt(rate * rate + 2 * bend * room);
  return rate > 0 ? 2 * room / (rate + root) : (root - rate) / bend;
}

double time_until(const Approach& approach, double level) {
  const double room = approach.gap - level;
  if (!(room > 0)) return 0;
  const double steadily = approach.ahead.steady > 0 ? room / approach.ahead.steady : INFINITY;
  return std::fmax(steadily, time_by_bend(room, approach.ahead.rate, approach.bend));
}

// The least value of the bound over 0 <= s <= window. If the rate is negative, the gap first opens. The bound is
// concave, so its least value is at an end.
double least(double gap, const Approach::Speed& speed, double bend, double window) {
  const double steadily = gap - speed.steady * window;
  const double bent = gap - speed.rate * window - bend * window * window / 2;
  return std::fmin(gap, std::fmax(steadily, bent));
}

}  // namespace

double time_below(Vec3 p, const Moving& turning, Vec3 n, double height, double limit) {
  const double speed = norm(turning.spin);
  const Vec3 axis = turning.spin * (1 / speed), r = p - turning.centre;
  const double a = dot(n, r) - dot(n, axis) * dot(axis, r), b = dot(n, cross(axis, r));
  const double error = (kHeightError + kSpinError * speed * limit) * (norm(p) + norm(turning.centre));
  const double room = height - dot(n, p) - error;
  if (!(room > 0)) return 0;
  const double radius = scaled_norm({a, b, 0});
  if (a + room >= radius) return limit;
  // The height is reached this angle before the top of the circle.
  const double before_top = angle_of_cosine((a + room) / radius), top = direction_angle(b, a);
  const double angle = top > 0 ? std::fmax(top - before_top, 0.0) : top - before_top + 2 * std::numbers::pi;
  return std::fmin(angle / speed, limit);
}

double MotionQuestion::answer(const Approach& approach) const {
  if (std::isnan(approach.gap)) return trivial();
  if (time_) return std::fmin(time_until(approach, level_), extent_);
  return std::fmin(least(approach.gap, approach.ahead, approach.bend, extent_),
                   least(approach.gap, approach.back, approach.bend, extent_));
}

}  // namespace satcheck
