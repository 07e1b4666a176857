#include "moving_shapes.hpp"

#include "minkowski.hpp"
#include "narrow_phase.hpp"

namespace satcheck {
namespace {

// A shape, placed, with the box about it in its own frame.
class PlacedShape {
 public:
  PlacedShape(const Shape& shape, const Pose& pose) : shape_(shape), core_(core_placement(shape, pose)) {
    Vec3 high{support({1, 0, 0}), support({0, 1, 0}), support({0, 0, 1})};
    Vec3 low{-support({-1, 0, 0}), -support({0, -1, 0}), -support({0, 0, -1})};
    centre_ = core_ * ((low + high) * 0.5);
    radius_ = norm(high - low) * 0.5;
  }

  Interval along(Vec3 n) const {
    const Vec3 m = transpose_times(core_.rotation, n);
    const double middle = dot(n, core_.translation), margin = shape_.margin * norm(n);
    return {middle + dot(m, core_support(shape_, -m).point) - margin,
            middle + dot(m, core_support(shape_, m).point) + margin};
  }
  double turning(const Moving& moving) const {
    return norm(cross(moving.spin, centre_ - moving.centre)) + norm(moving.spin) * radius_;
  }
  Vec3 centre() const { return centre_; }

 private:
  double support(Vec3 m) const { return dot(m, core_support(shape_, m).point) + shape_.margin; }

  const Shape& shape_;
  Pose core_;
  Vec3 centre_;
  double radius_;
};

}  // namespace

MotionAnswer ask_motion(const Shape& a, const Moving& moving_a, const Shape& b, const Moving& moving_b,
                        const MotionQuestion& question, const MotionRounding& rounding) {
  const PairResult now = check_pair(a, moving_a.pose, b, moving_b.pose, Query::depth);
  const PlacedShape part_a(a, moving_a.pose), part_b(b, moving_b.pose);
  MotionAnswer result;
  result.value = question.trivial();
  result.visits = 1;
  if (!now.has_distance) return result;
  result.upper = now.upper;
  const Views views(moving_a, moving_b);
  const auto consider = [&](Vec3 axis) { raise_answer(part_a, part_b, axis, views, rounding, question, result.value); };
  consider(now.normal);
  const Vec3 v = moving_a.velocity_at(now.witness_a) - moving_b.velocity_at(now.witness_b);
  if (norm_squared(v) > 0) consider(now.normal - v * (dot(now.normal, v) / norm_squared(v)));
  return result;
}

}  // namespace satcheck
