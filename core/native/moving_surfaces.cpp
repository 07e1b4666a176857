#include "moving_surfaces.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "triangle_distance.hpp"

namespace satcheck {
namespace {

// A box of the tree, placed.
struct PlacedBox {
  const Mat3& rotation;
  Vec3 centre, half;  // world; along the axes of the body
  double radius;

  PlacedBox(const Aabb& box, const Pose& pose)
      : rotation(pose.rotation),
        centre(pose * (box.min * 0.5 + box.max * 0.5)),
        half(box.max * 0.5 - box.min * 0.5),
        radius(norm(half)) {}

  Interval along(Vec3 n) const {
    const Vec3 m = transpose_times(rotation, n);
    const double middle = dot(n, centre);
    const double reach = std::fabs(m.x) * half.x + std::fabs(m.y) * half.y + std::fabs(m.z) * half.z;
    return {middle - reach, middle + reach};
  }
  double turning(const Moving& moving) const {
    return norm(cross(moving.spin, centre - moving.centre)) + norm(moving.spin) * radius;
  }
  Vec3 axis(int k) const { return {rotation.row[0][k], rotation.row[1][k], rotation.row[2][k]}; }
};

struct PlacedTriangle {
  Corners corners;

  PlacedTriangle(const Surface& surface, std::uint32_t triangle, const Pose& pose)
      : corners(satcheck::corners(surface.mesh, triangle)) {
    for (Vec3& p : corners) p = pose * p;
  }

  Interval along(Vec3 n) const {
    const double x = dot(n, corners[0]), y = dot(n, corners[1]), z = dot(n, corners[2]);
    return {std::fmin(x, std::fmin(y, z)), std::fmax(x, std::fmax(y, z))};
  }
  double turning(const Moving& moving) const {
    double largest = 0;
    for (const Vec3& p : corners) largest = std::fmax(largest, norm(cross(moving.spin, p - moving.centre)));
    return largest;
  }
  Vec3 centre() const { return (corners[0] + corners[1] + corners[2]) * (1.0 / 3); }
  Vec3 normal() const { return cross(corners[1] - corners[0], corners[2] - corners[0]); }
};

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
    // Depth first, the child that is more in the way first: the bound gets good early.
    while (!stack_.empty() && result_.value > question_.smallest()) {
      const NodePair pair = stack_.back();
      stack_.pop_back();
      if (!(pair.value < result_.value)) continue;
      if (result_.visits >= work_) {  // what is left may be as much in the way as its bounds say
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
    if (enough(apart) || enough(across_motion(apart, a.centre, b.centre))) return {value, pair.first, pair.second};
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
    const Witnesses nearest = triangle_distance(a.corners, b.corners);
    const Vec3 apart = nearest.b - nearest.a;
    if (enough(apart) || enough(across_motion(apart, nearest.a, nearest.b))) return;
    result_.value = value;
    result_.upper = std::fmin(result_.upper, std::sqrt(nearest.distance_squared));
    result_.triangle_a = ta;
    result_.triangle_b = tb;
  }

  // Tries an axis; whether the pair is no more in the way than what is known.
  template <class Part>
  bool improve(const Part& a, const Part& b, Vec3 axis, double& value) const {
    raise_answer(a, b, axis, views_, rounding_, question_, value);
    return !(value < result_.value);
  }

  static Vec3 towards(Vec3 axis, Vec3 direction) { return dot(axis, direction) < 0 ? -axis : axis; }

  // What is left of the direction across the relative motion of the two points.
  Vec3 across_motion(Vec3 direction, Vec3 on_a, Vec3 on_b) const {
    const Vec3 v = views_.world().a.velocity_at(on_a) - views_.world().b.velocity_at(on_b);
    const double squared = norm_squared(v);
    return squared > 0 ? direction - v * (dot(direction, v) / squared) : Vec3{};
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
