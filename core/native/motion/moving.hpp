// A moving rigid body, and how fast its gap to another body can close.
//
// The axis n is fixed in the world while the bodies move. A point p = centre + r of a body that turns with
// the angular velocity w about an axis through `centre`, which itself moves with v, has
//   n . (p(s) - p(0)) <= s (n . v + r . (n x w)) + s^2 / 2 |n x w| |w x r|        (Taylor)
//   n . (p(s) - p(0)) <= s (n . v + |n x w| |w x r| / |w|)                         (r turns at a fixed radius)
// for every s >= 0: the second derivative of the turning part is |n x w| |w x r| at most. A body that several joints
// carry moves so only at first; bounds of the speed and the acceleration of its points then stand in for the others.
// The motion bound of
// Brian Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems" (1996), 2.3, taken along the axis as by Xinyu
// Zhang, Minkyoung Lee, Young J. Kim, "Interactive Continuous Collision Detection for Non-convex Polyhedra" (2006).
// Bodies that slide past each other therefore keep large steps.
#pragma once

#include "base/vec.hpp"

namespace satcheck {

struct Moving {
  Pose pose;      // places the body now: p_world = rotation * p + translation
  Vec3 centre;    // world, on the axis it turns about
  Vec3 velocity;  // of the centre, per unit of time
  Vec3 spin;      // unit axis times radians per unit of time, right-handed
  // Bounds for all points, if velocity and spin change; else 0.
  double speed = 0, acceleration = 0;

  Vec3 velocity_at(Vec3 world) const { return velocity + cross(spin, world - centre); }
  bool is_steady() const { return speed == 0; }
  bool stands() const { return is_steady() && velocity == Vec3{} && spin == Vec3{}; }
  bool only_turns() const { return is_steady() && velocity == Vec3{} && !(spin == Vec3{}); }
};

// The time until which the point p of a body that only turns stays below a height along the unit direction n, up to
// `limit`. The height of a point on its circle is that of the circle's centre plus a sine.
double time_below(Vec3 p, const Moving& turning, Vec3 n, double height, double limit);

// The frames in which two bodies are seen. In the world, the axis of a gap is fixed. If one body is at rest and the
// other turns about a fixed axis, the frame may also turn with that body. The axis of the gap then turns too, like the
// normal of a door that opens.
class Views {
 public:
  struct View {
    Moving a, b;
  };

  Views(const Moving& a, const Moving& b) : views_{{a, b}, {a, b}} {
    if (a.only_turns() && b.stands()) exchange(views_[1].a, views_[1].b);
    if (b.only_turns() && a.stands()) exchange(views_[1].b, views_[1].a);
  }

  const View* begin() const { return views_; }
  const View* end() const { return views_ + count_; }
  const View& world() const { return views_[0]; }

 private:
  void exchange(Moving& turning, Moving& standing) {
    standing.centre = turning.centre;
    standing.spin = -turning.spin;
    turning.spin = {};
    count_ = 2;
  }

  View views_[2];
  int count_ = 1;
};

// The rounding errors of a gap, and of the rate at which it closes.
struct MotionRounding {
  double gap = 0, rate = 0;
};

struct Extent {
  double low, high;
};

// Bounds of the future gap along one axis. It is at least gap - rate s - bend s^2 / 2, and at least gap - steady s. The
// first members hold for s >= 0; the values for s <= 0 are in `back`.
struct Approach {
  struct Speed {
    double rate = 0, steady = 0;
  };
  double gap, bend = 0;
  Speed ahead, back;
};

// The requested value of a pair. It is smaller for pairs that are a closer obstacle.
class MotionQuestion {
 public:
  // The time for which the gap stays above the level, at most `limit`.
  static MotionQuestion time(double level, double limit) { return {true, level, limit}; }
  // The least gap from `window` before now to `window` after. If it is below `floor`, any value below `floor` will do.
  static MotionQuestion gap(double window, double floor = -INFINITY) { return {false, floor, window}; }

  // A lower bound of the answer.
  double answer(const Approach& approach) const;
  // Whether a pair with this gap now may have a larger answer than a known one.
  bool may_raise(double gap, double known) const { return time_ ? gap > level_ : gap > known; }
  bool is_time() const { return time_; }
  // The gap that shall be kept, for a time.
  double level() const { return level_; }
  // The limit of a time, or half the window of a gap.
  double extent() const { return extent_; }
  // No answer is larger.
  double largest() const { return time_ ? extent_ : INFINITY; }
  // No smaller answer is of use.
  double smallest() const { return time_ ? 0.0 : level_; }
  // The answer that always holds.
  double trivial() const { return time_ ? 0.0 : -INFINITY; }

 private:
  MotionQuestion(bool time, double level, double extent) : time_(time), level_(level), extent_(extent) {}

  bool time_;
  double level_, extent_;
};

// The unit vector along the axis, for any length; zero if the axis is zero.
inline Vec3 unit_along(Vec3 axis) {
  const double largest = max_abs(axis), inverse = 1 / largest;
  if (!(largest > 0) || !is_finite(axis) || !std::isfinite(inverse)) return {};
  const Vec3 small = axis * inverse;
  return small * (1 / norm(small));
}

// Part: `Extent along(Vec3 world direction)`, the extent of dot(direction, p) over its points, and
// `double turning(const Moving&)`, an upper bound of |spin x r|.
template <class Part>
void add_approach(const Part& part, const Moving& moving, Vec3 n, bool towards, Approach& approach) {
  const double sign = towards ? 1 : -1, drift = sign * dot(n, moving.velocity);
  approach.ahead.rate += drift;
  approach.ahead.steady += moving.is_steady() ? drift : moving.speed;
  approach.back.rate -= drift;
  approach.back.steady += moving.is_steady() ? -drift : moving.speed;
  approach.bend += moving.acceleration;
  if (moving.spin == Vec3{}) return;
  const Vec3 w = cross(n, moving.spin);
  const double offset = dot(w, moving.centre);
  const Extent extent = part.along(w);
  const double low = extent.low - offset, high = extent.high - offset;
  approach.ahead.rate += towards ? high : -low;
  approach.back.rate += towards ? -low : high;
  if (!moving.is_steady()) return;
  const double across = norm(w), turning = part.turning(moving), steady = across * turning / norm(moving.spin);
  approach.ahead.steady += steady;
  approach.back.steady += steady;
  approach.bend += across * turning;
}

// Bounds of the future gap along a unit axis from A to B in one view.
template <class PartA, class PartB>
Approach approach_of(double gap, const PartA& a, const PartB& b, const Views::View& view, Vec3 n, double rounding) {
  Approach approach{gap, 0, {rounding, rounding}, {rounding, rounding}};
  add_approach(a, view.a, n, true, approach);
  add_approach(b, view.b, n, false, approach);
  return approach;
}

// The time, up to `limit`, for which all points of a part that only turns stay below a height along n. No time is
// proven for a part without corners. Bodies that turn about a line of their contact stay in contact there; their other
// points leave it, which no bound of the whole part by its fastest point shows.
template <class Part>
double time_below(const Part& part, const Moving& turning, Vec3 n, double height, double limit) {
  if (!part.has_corners()) return 0;
  part.each_corner([&](Vec3 p) {
    if (limit > 0) limit = time_below(p, turning, n, height, limit);
  });
  return limit;
}

// The time for which the plane between the bodies, in one view, keeps their points apart; 0 unless one body stands and
// the other only turns.
template <class PartA, class PartB>
double time_by_corners(const PartA& a, const PartB& b, const Views::View& view, Vec3 n, const MotionRounding& rounding,
                       const MotionQuestion& question) {
  const double limit = question.largest(), room = question.level() + rounding.gap + rounding.rate * limit;
  if (view.a.only_turns() && view.b.stands()) return time_below(a, view.a, n, b.along(n).low - room, limit);
  if (view.b.only_turns() && view.a.stands()) return time_below(b, view.b, -n, -a.along(n).high - room, limit);
  return 0;
}

// Raises `answer`, a lower bound of the requested value, to what an axis from A to B, of any length, proves in all
// views.
template <class PartA, class PartB>
void raise_answer(const PartA& a, const PartB& b, Vec3 axis, const Views& views, const MotionRounding& rounding,
                  const MotionQuestion& question, double& answer) {
  const Vec3 n = unit_along(axis);
  if (n == Vec3{}) return;
  const double gap = b.along(n).low - a.along(n).high - rounding.gap;
  if (!question.may_raise(gap, answer)) return;
  for (const Views::View& view : views) {
    answer = std::fmax(answer, question.answer(approach_of(gap, a, b, view, n, rounding.rate)));
    if (question.is_time() && answer < question.largest()) {
      answer = std::fmax(answer, time_by_corners(a, b, view, n, rounding, question));
    }
  }
}

}  // namespace satcheck
