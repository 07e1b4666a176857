#include "motion/moving_shapes.hpp"

#include "convex/narrow_phase.hpp"
#include "motion/moving_parts.hpp"

namespace satcheck {
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
  consider(across_motion(now.normal, views, now.witness_a, now.witness_b));
  return result;
}

}  // namespace satcheck
