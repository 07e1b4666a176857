#include "motion/moving_surfaces.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "exact/triangle_distance.hpp"
#include "motion/moving_parts.hpp"

namespace satcheck {
namespace {

struct NodePair {
  double value;
  std::uint32_t a, b;
};

class MotionSearch {
 public:
  MotionSearch(const Surface& a, const Moving& moving_a, const Surface& b, const Moving& moving_b,
               const MotionQuestion& question, const MotionRounding& rounding, std::uint64_t work)
      : a_(a), b_(b), moving_a_(moving_a), moving_b_(moving_b), views_(moving_a, moving_b), question_(question), rounding_(rounding), work_(work) {
    result_.value = question.largest();
  }

  MotionAnswer run() {
    push_two({0, 0}, {0, 0}, 1);
    // Depth first; the child with the smaller bound first, so that the bound is good early.
    while (!stack_.empty() && result_.value > question_.smallest()) {
      const NodePair pair = stack_.back();
      stack_.pop_back();
      if (!(pair.value < result_.value)) continue;
      if (result_.visits >= work_) {  // the remaining pairs count with their bounds
        result_.value = pair.value;
        continue;
      }
      const BvhNode &m = a_.bvh.nodes[pair.a], &n = b_.bvh.nodes[pair.b];
      if (m.is_leaf() && n.is_leaf()) {
        visit_leaves(m, n);
      } else if (n.is_leaf() || (!m.is_leaf() && size(m) >= size(n))) {
        push_two({m.first, pair.b}, {m.first + 1, pair.b}, 2);
      } else {
        push_two({pair.a, n.first}, {pair.a, n.first + 1}, 2);
      }
    }
    if (!stack_.empty()) result_.value = question_.trivial();
    return result_;
  }

 private:
  using Indices = std::pair<std::uint32_t, std::uint32_t>;

  static double size(const BvhNode& node) { return norm_squared(node.box.max - node.box.min); }

  void push_two(Indices x, Indices y, int count) {
    NodePair first = make(x), second = count == 2 ? make(y) : first;
    if (first.value < second.value) std::swap(first, second);
    if (first.value < result_.value) stack_.push_back(first);
    if (count == 2 && second.value < result_.value) stack_.push_back(second);
  }

  NodePair make(Indices pair) {
    ++result_.visits;
    const PlacedBox a(a_.bvh.nodes[pair.first].box, moving_a_.pose), b(b_.bvh.nodes[pair.second].box, moving_b_.pose);
    const Vec3 apart = b.centre - a.centre;
    double value = question_.trivial();
    const auto enough = [&](Vec3 axis) { return improve(a, b, axis, value); };
    if (enough(apart) || enough(across_motion(apart, views_, a.centre, b.centre))) return {value, pair.first, pair.second};
    for (int k = 0; k < 3; ++k) {
      if (enough(towards(a.axis(k), apart)) || enough(towards(b.axis(k), apart))) break;
    }
    return {value, pair.first, pair.second};
  }

  void visit_leaves(const BvhNode& m, const BvhNode& n) {
    for (std::uint32_t k = m.first; k < m.first + m.count; ++k) {
      const PlacedTriangle a(a_, a_.bvh.order[k], moving_a_.pose);
      for (std::uint32_t l = n.first; l < n.first + n.count; ++l) {
        visit(a, a_.bvh.order[k], PlacedTriangle(b_, b_.bvh.order[l], moving_b_.pose), b_.bvh.order[l]);
      }
    }
  }

  void visit(const PlacedTriangle& a, std::uint32_t ta, const PlacedTriangle& b, std::uint32_t tb) {
    ++result_.visits;
    double value = question_.trivial();
    const auto enough = [&](Vec3 axis) { return improve(a, b, axis, value); };
    const Vec3 middle = b.centre() - a.centre();
    if (enough(towards(a.normal(), middle)) || enough(towards(b.normal(), middle))) return;
    const NearestPoints nearest = triangle_distance(a.corners, b.corners);
    const Vec3 apart = nearest.b - nearest.a;
    if (enough(apart) || enough(across_motion(apart, views_, nearest.a, nearest.b))) return;
    // Rounding of the nearest points tilts the axis of a small gap. Between two edges their normal has no such error.
    for (int k = 0; k < 9 && value == question_.trivial(); ++k) {
      if (enough(towards(cross(a.edge(k / 3), b.edge(k % 3)), apart))) return;
    }
    result_.value = value;
    result_.upper = std::fmin(result_.upper, std::sqrt(nearest.distance_squared));
    result_.triangle_a = ta;
    result_.triangle_b = tb;
  }

  // Tries an axis. Returns whether the pair is no closer obstacle than the known one.
  template <class Part>
  bool improve(const Part& a, const Part& b, Vec3 axis, double& value) const {
    raise_answer(a, b, axis, views_, rounding_, question_, value);
    return !(value < result_.value);
  }

  const Surface& a_;
  const Surface& b_;
  const Moving& moving_a_;
  const Moving& moving_b_;
  Views views_;
  const MotionQuestion& question_;
  const MotionRounding& rounding_;
  std::uint64_t work_;
  MotionAnswer result_;
  std::vector<NodePair> stack_;
};

}  // namespace

MotionAnswer ask_motion(const Surface& a, const Moving& moving_a, const Surface& b, const Moving& moving_b,
                        const MotionQuestion& question, const MotionRounding& rounding, std::uint64_t work) {
  if (a.bvh.nodes.empty() || b.bvh.nodes.empty()) throw std::invalid_argument("a surface is empty");
  return MotionSearch(a, moving_a, b, moving_b, question, rounding, work).run();
}

}  // namespace satcheck
