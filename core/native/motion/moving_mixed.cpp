#include "motion/moving_mixed.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "convex/narrow_phase.hpp"
#include "motion/moving_parts.hpp"

namespace satcheck {
namespace {

struct Node {
  double value;
  std::uint32_t index;
};

class MixedSearch {
 public:
  MixedSearch(const Shape& a, const Moving& moving_a, const Surface& b, const Moving& moving_b,
              const MotionQuestion& question, const MotionRounding& rounding)
      : shape_(a), a_(a, moving_a.pose), b_(b), moving_a_(moving_a), moving_b_(moving_b), views_(moving_a, moving_b),
        question_(question), rounding_(rounding) {
    result_.value = question.largest();
  }

  MotionAnswer run(std::uint64_t work) {
    push(0);
    // Depth first; the child with the smaller bound first.
    while (!stack_.empty() && result_.value > question_.smallest()) {
      const Node node = stack_.back();
      stack_.pop_back();
      if (!(node.value < result_.value)) continue;
      if (result_.visits >= work) {
        result_.value = node.value;
        continue;
      }
      const BvhNode& n = b_.bvh.nodes[node.index];
      if (n.is_leaf()) {
        for (std::uint32_t k = n.first; k < n.first + n.count; ++k) visit(b_.bvh.order[k]);
      } else {
        push(n.first);
        push(n.first + 1);
        const std::size_t last = stack_.size() - 1;
        if (last > 0 && stack_[last - 1].value < stack_[last].value) std::swap(stack_[last - 1], stack_[last]);
      }
    }
    if (!stack_.empty()) result_.value = question_.trivial();
    return result_;
  }

 private:
  void push(std::uint32_t index) {
    ++result_.visits;
    const PlacedBox box(b_.bvh.nodes[index].box, moving_b_.pose);
    const Vec3 apart = box.centre - a_.centre();
    double value = question_.trivial();
    raise(box, apart, value);
    raise(box, across_motion(apart, views_, a_.centre(), box.centre), value);
    for (int k = 0; k < 3 && value < result_.value; ++k) raise(box, towards(box.axis(k), apart), value);
    stack_.push_back({value, index});
  }

  void visit(std::uint32_t index) {
    ++result_.visits;
    const PlacedTriangle triangle(b_, index, moving_b_.pose);
    double value = question_.trivial();
    raise(triangle, towards(triangle.normal(), triangle.centre() - a_.centre()), value);
    if (!(value < result_.value)) return;
    const std::vector<Vec3> corners(triangle.corners.begin(), triangle.corners.end());
    const PairResult now = check_pair(shape_, moving_a_.pose, make_hull(corners), {}, Query::distance);
    if (now.has_distance) {
      raise(triangle, now.normal, value);
      raise(triangle, across_motion(now.normal, views_, now.witness_a, now.witness_b), value);
      result_.upper = std::fmin(result_.upper, now.upper);
    }
    if (!(value < result_.value)) return;
    result_.value = value;
    result_.triangle_b = index;
  }

  template <class Part>
  void raise(const Part& part, Vec3 axis, double& value) const {
    raise_answer(a_, part, axis, views_, rounding_, question_, value);
  }

  const Shape& shape_;
  PlacedShape a_;
  const Surface& b_;
  const Moving& moving_a_;
  const Moving& moving_b_;
  Views views_;
  const MotionQuestion& question_;
  const MotionRounding& rounding_;
  MotionAnswer result_;
  std::vector<Node> stack_;
};

}  // namespace

MotionAnswer ask_motion(const Shape& a, const Moving& moving_a, const Surface& b, const Moving& moving_b,
                        const MotionQuestion& question, const MotionRounding& rounding, std::uint64_t work) {
  if (b.bvh.nodes.empty()) throw std::invalid_argument("a surface is empty");
  return MixedSearch(a, moving_a, b, moving_b, question, rounding).run(work);
}

}  // namespace satcheck
