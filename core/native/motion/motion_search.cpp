#include "motion/motion_search.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "convex/minkowski.hpp"
#include "convex/narrow_phase.hpp"
#include "exact/triangle_distance.hpp"
#include "motion/moving.hpp"

namespace satcheck {
namespace {

// A box of the tree, placed.
class PlacedBox {
 public:
  PlacedBox(const Aabb& box, const Pose& pose)
      : rotation_(pose.rotation),
        centre_(pose * box.centre()),
        half_(box.max * 0.5 - box.min * 0.5),
        radius_(norm(half_)) {}

  Extent along(Vec3 n) const {
    const Vec3 m = transpose_times(rotation_, n);
    const double middle = dot(n, centre_), reach = reach_along(m, half_);
    return {middle - reach, middle + reach};
  }
  double turning(const Moving& moving) const {
    return norm(cross(moving.spin, centre_ - moving.centre)) + norm(moving.spin) * radius_;
  }
  bool has_corners() const { return true; }
  template <class Visit>
  void each_corner(Visit&& visit) const {
    for (int k = 0; k < 8; ++k) {
      visit(centre_ + axis(0) * (k & 1 ? half_.x : -half_.x) + axis(1) * (k & 2 ? half_.y : -half_.y) +
            axis(2) * (k & 4 ? half_.z : -half_.z));
    }
  }
  Vec3 axis(int k) const { return {rotation_.row[0][k], rotation_.row[1][k], rotation_.row[2][k]}; }
  Vec3 centre() const { return centre_; }

 private:
  const Mat3& rotation_;
  Vec3 centre_, half_;  // world; along the axes of the body
  double radius_;
};

struct PlacedTriangle {
  std::array<Vec3, 3> corners;

  PlacedTriangle(const Surface& surface, std::uint32_t triangle, const Pose& pose)
      : corners(satcheck::corners(surface.mesh, triangle)) {
    for (Vec3& p : corners) p = pose * p;
  }

  Extent along(Vec3 n) const {
    const double x = dot(n, corners[0]), y = dot(n, corners[1]), z = dot(n, corners[2]);
    return {std::fmin(x, std::fmin(y, z)), std::fmax(x, std::fmax(y, z))};
  }
  double turning(const Moving& moving) const {
    double largest = 0;
    for (const Vec3& p : corners) largest = std::fmax(largest, norm(cross(moving.spin, p - moving.centre)));
    return largest;
  }
  bool has_corners() const { return true; }
  template <class Visit>
  void each_corner(Visit&& visit) const {
    for (const Vec3& p : corners) visit(p);
  }
  Vec3 centre() const { return (corners[0] + corners[1] + corners[2]) * (1.0 / 3); }
  Vec3 edge(int k) const { return corners[(k + 1) % 3] - corners[k]; }
  Vec3 normal() const { return cross(corners[1] - corners[0], corners[2] - corners[0]); }
};

// A shape, placed, with the box about it in its own frame.
class PlacedShape {
 public:
  PlacedShape(const Shape& shape, const Pose& pose) : shape_(shape), core_(core_placement(shape, pose)) {
    Vec3 high{support({1, 0, 0}), support({0, 1, 0}), support({0, 0, 1})};
    Vec3 low{-support({-1, 0, 0}), -support({0, -1, 0}), -support({0, 0, -1})};
    centre_ = core_ * ((low + high) * 0.5);
    radius_ = norm(high - low) * 0.5;
  }

  Extent along(Vec3 n) const {
    const Vec3 m = transpose_times(core_.rotation, n);
    const double middle = dot(n, core_.translation), margin = shape_.margin * norm(n);
    return {middle + dot(m, core_support(shape_, -m).point) - margin,
            middle + dot(m, core_support(shape_, m).point) + margin};
  }
  double turning(const Moving& moving) const {
    return norm(cross(moving.spin, centre_ - moving.centre)) + norm(moving.spin) * radius_;
  }
  bool has_corners() const { return shape_.kind == ShapeKind::hull; }
  template <class Visit>
  void each_corner(Visit&& visit) const {
    const VertexLanes& v = shape_.lanes;
    for (std::size_t k = 0; k < v.padded(); ++k) visit(core_ * Vec3{v.x[k], v.y[k], v.z[k]});
  }
  Vec3 centre() const { return centre_; }
  const Shape& shape() const { return shape_; }

 private:
  double support(Vec3 m) const { return dot(m, core_support(shape_, m).point) + shape_.margin; }

  const Shape& shape_;
  Pose core_;
  Vec3 centre_;
  double radius_;
};

// The axis, turned round where it points against the direction.
Vec3 towards(Vec3 axis, Vec3 direction) { return dot(axis, direction) < 0 ? -axis : axis; }

// The component of a direction perpendicular to the relative motion of two points, world.
Vec3 across_motion(Vec3 direction, const Views& views, Vec3 on_a, Vec3 on_b) {
  const Vec3 v = views.world().a.velocity_at(on_a) - views.world().b.velocity_at(on_b);
  const double squared = norm_squared(v);
  return squared > 0 ? direction - v * (dot(direction, v) / squared) : Vec3{};
}

// The boxes and the triangles of a surface, placed.
class SurfaceTree {
 public:
  SurfaceTree(const Surface& surface, const Moving& moving) : surface_(surface), pose_(moving.pose) {
    if (surface.bvh.nodes.empty()) throw std::invalid_argument("a surface is empty");
  }

  bool is_leaf(std::uint32_t node) const { return surface_.bvh.nodes[node].is_leaf(); }
  std::uint32_t first_child(std::uint32_t node) const { return surface_.bvh.nodes[node].first; }
  double size(std::uint32_t node) const {
    return norm_squared(surface_.bvh.nodes[node].box.size());
  }
  PlacedBox whole(std::uint32_t node) const { return {surface_.bvh.nodes[node].box, pose_}; }
  template <class Visit>
  void each_part(std::uint32_t node, Visit&& visit) const {
    const BvhNode& leaf = surface_.bvh.nodes[node];
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.count; ++k) {
      visit(PlacedTriangle(surface_, surface_.bvh.order[k], pose_), surface_.bvh.order[k]);
    }
  }

 private:
  const Surface& surface_;
  const Pose& pose_;
};

// A shape, placed: a tree of one part.
class ShapeTree {
 public:
  ShapeTree(const Shape& shape, const Moving& moving) : part_(shape, moving.pose) {}

  bool is_leaf(std::uint32_t) const { return true; }
  std::uint32_t first_child(std::uint32_t) const { return 0; }
  double size(std::uint32_t) const { return 0; }
  const PlacedShape& whole(std::uint32_t) const { return part_; }
  template <class Visit>
  void each_part(std::uint32_t, Visit&& visit) const {
    visit(part_, kNoIndex);
  }

 private:
  PlacedShape part_;
};

struct NodePair {
  double value;
  std::uint32_t a, b;
};

template <class TreeA, class TreeB>
class MotionSearch {
 public:
  MotionSearch(const TreeA& a, const Moving& moving_a, const TreeB& b, const Moving& moving_b,
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
      if (a_.is_leaf(pair.a) && b_.is_leaf(pair.b)) {
        visit_parts(pair.a, pair.b);
      } else if (b_.is_leaf(pair.b) || (!a_.is_leaf(pair.a) && a_.size(pair.a) >= b_.size(pair.b))) {
        const std::uint32_t child = a_.first_child(pair.a);
        push_two({child, pair.b}, {child + 1, pair.b}, 2);
      } else {
        const std::uint32_t child = b_.first_child(pair.b);
        push_two({pair.a, child}, {pair.a, child + 1}, 2);
      }
    }
    if (!stack_.empty()) result_.value = question_.trivial();
    return result_;
  }

  // For two trees of one part each.
  MotionAnswer run_parts() {
    visit_parts(0, 0);
    return result_;
  }

 private:
  using Indices = std::pair<std::uint32_t, std::uint32_t>;

  void push_two(Indices x, Indices y, int count) {
    NodePair first = make(x), second = count == 2 ? make(y) : first;
    if (first.value < second.value) std::swap(first, second);
    if (first.value < result_.value) stack_.push_back(first);
    if (count == 2 && second.value < result_.value) stack_.push_back(second);
  }

  NodePair make(Indices pair) {
    ++result_.visits;
    const auto& a = a_.whole(pair.first);
    const auto& b = b_.whole(pair.second);
    const Vec3 apart = b.centre() - a.centre();
    double value = question_.trivial();
    const auto enough = [&](Vec3 axis) { return improve(a, b, axis, value); };
    if (enough(apart) || enough(across_motion(apart, views_, a.centre(), b.centre()))) return {value, pair.first, pair.second};
    for (int k = 0; k < 3; ++k) {
      if (box_axis(a, k, apart, enough) || box_axis(b, k, apart, enough)) break;
    }
    return {value, pair.first, pair.second};
  }

  template <class Enough>
  static bool box_axis(const PlacedBox& box, int k, Vec3 apart, Enough&& enough) { return enough(towards(box.axis(k), apart)); }
  template <class Enough>
  static bool box_axis(const PlacedShape&, int, Vec3, Enough&&) { return false; }

  void visit_parts(std::uint32_t i, std::uint32_t j) {
    a_.each_part(i, [&](const auto& a, std::uint32_t triangle_a) {
      b_.each_part(j, [&](const auto& b, std::uint32_t triangle_b) {
        ++result_.visits;
        double value = question_.trivial();
        if (is_farther(a, b, value)) return;
        result_.value = value;
        result_.triangle_a = triangle_a;
        result_.triangle_b = triangle_b;
      });
    });
  }

  // Whether two parts are no closer obstacle than the known one; `value` is raised to what is proven of them.
  bool is_farther(const PlacedTriangle& a, const PlacedTriangle& b, double& value) {
    const auto enough = [&](Vec3 axis) { return improve(a, b, axis, value); };
    const Vec3 middle = b.centre() - a.centre();
    if (enough(towards(a.normal(), middle)) || enough(towards(b.normal(), middle))) return true;
    const NearestPoints nearest = triangle_distance(a.corners, b.corners);
    const Vec3 apart = nearest.b - nearest.a;
    if (enough(apart) || enough(across_motion(apart, views_, nearest.a, nearest.b))) return true;
    // Rounding of the nearest points tilts the axis of a small gap. Between two edges their normal has no such error.
    for (int k = 0; k < 9 && value == question_.trivial(); ++k) {
      if (enough(towards(cross(a.edge(k / 3), b.edge(k % 3)), apart))) return true;
    }
    result_.upper = std::fmin(result_.upper, std::sqrt(nearest.distance_squared));
    return false;
  }

  bool is_farther(const PlacedShape& a, const PlacedTriangle& b, double& value) {
    if (improve(a, b, towards(b.normal(), b.centre() - a.centre()), value)) return true;
    const Shape triangle = make_hull({b.corners.begin(), b.corners.end()});
    return is_farther_along(a, b, check_pair(a.shape(), moving_a_.pose, triangle, {}, Query::distance), value);
  }

  bool is_farther(const PlacedShape& a, const PlacedShape& b, double& value) {
    return is_farther_along(a, b, check_pair(a.shape(), moving_a_.pose, b.shape(), moving_b_.pose, Query::depth), value);
  }

  // The same, along the axis between two parts now.
  template <class PartB>
  bool is_farther_along(const PlacedShape& a, const PartB& b, const PairResult& now, double& value) {
    if (!now.has_distance) return false;
    result_.upper = std::fmin(result_.upper, now.upper);
    improve(a, b, now.normal, value);
    return improve(a, b, across_motion(now.normal, views_, now.witness_a, now.witness_b), value);
  }

  // Tries an axis. Returns whether the pair is no closer obstacle than the known one.
  template <class PartA, class PartB>
  bool improve(const PartA& a, const PartB& b, Vec3 axis, double& value) const {
    raise_answer(a, b, axis, views_, rounding_, question_, value);
    return !(value < result_.value);
  }

  const TreeA& a_;
  const TreeB& b_;
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

MotionAnswer ask_motion(const MovingBody& a, const Moving& moving_a, const MovingBody& b, const Moving& moving_b,
                        const MotionQuestion& question, const MotionRounding& rounding, std::uint64_t work) {
  const auto *surface_a = std::get_if<const Surface*>(&a), *surface_b = std::get_if<const Surface*>(&b);
  if (surface_a && !surface_b) {  // a shape comes first
    MotionAnswer answer = ask_motion(b, moving_b, a, moving_a, question, rounding, work);
    std::swap(answer.triangle_a, answer.triangle_b);
    return answer;
  }
  if (surface_a) {
    return MotionSearch(SurfaceTree(**surface_a, moving_a), moving_a, SurfaceTree(**surface_b, moving_b), moving_b, question,
                        rounding, work).run();
  }
  const ShapeTree shape_a(*std::get<const Shape*>(a), moving_a);
  if (surface_b) {
    return MotionSearch(shape_a, moving_a, SurfaceTree(**surface_b, moving_b), moving_b, question, rounding, work).run();
  }
  return MotionSearch(shape_a, moving_a, ShapeTree(*std::get<const Shape*>(b), moving_b), moving_b, question, rounding,
                      work).run_parts();
}

}  // namespace satcheck
