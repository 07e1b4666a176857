#include "motion/moving.hpp"

namespace satcheck {
namespace {

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

double MotionQuestion::answer(const Approach& approach) const {
  if (std::isnan(approach.gap)) return trivial();
  if (time_) return std::fmin(time_until(approach, level_), extent_);
  return std::fmin(least(approach.gap, approach.ahead, approach.bend, extent_),
                   least(approach.gap, approach.back, approach.bend, extent_));
}

}  // namespace satcheck
