#include "mesh_pair/mesh_distance.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/rounding.hpp"
#include "convex/exact_distance.hpp"
#include "exact/double_double.hpp"
#include "exact/triangle_distance.hpp"
#include "mesh_pair/outline_pair.hpp"

namespace satcheck {
namespace {

// Measured steps of a pair of nodes, of a pair of triangles whose boxes are near, and of their distance.
constexpr std::uint64_t kNodesWork = 10, kBoxesWork = 10, kDistanceWork = 200;

// The plane of a triangle. Most nearby triangles are clearly farther from it than a bound.
class Beyond {
 public:
  explicit Beyond(const Corners& t) : from_(t[0]) {
    const Vec3 u = t[1] - t[0], v = t[2] - t[0];
    normal_ = cross(u, v);
    length_ = norm(normal_);
    permanent_ = norm(u) * norm(v);
  }

  // Whether the whole triangle is on one side, and certainly farther than `reach`. The error of a component of the
  // normal, and of its products with an offset, is a few roundoffs of the multiplied lengths.
  bool holds(const Corners& t, double reach) const {
    const double far = reach * (length_ + kNoise * permanent_);
    int sides = 0;
    for (const Vec3& p : t) {
      const Vec3 w = p - from_;
      const double height = dot(normal_, w), least = far + kNoise * permanent_ * norm(w);
      sides += height > least ? 1 : height < -least ? -1 : 0;
    }
    return sides == 3 || sides == -3;
  }

 private:
  static constexpr double kNoise = 32 * kUnitRoundoff;

  Vec3 from_, normal_;
  double length_, permanent_;
};

struct NearNodes {
  double distance_squared;
  std::uint32_t a, b;
};

class DistanceSearch {
 public:
  DistanceSearch(const Surface& a, const Surface& b, double limit, const TrianglePairTest& counts, Budget* budget)
      : a_(a), b_(b), counts_(counts), budget_(budget), bound_(limit * limit) {}

  MeshDistance run() {
    if (a_.bvh.nodes.empty() || b_.bvh.nodes.empty()) return result_;
    const Aabb &box_a = a_.bvh.nodes[0].box, &box_b = b_.bvh.nodes[0].box;
    rounding_ = chain_rounding(larger(box_a.largest_coordinate(), box_b.largest_coordinate()));
    push(0, 0);
    // Depth first, nearer child first, so that the bound is good early and the stack is short.
    while (!stack_.empty() && result_.distance > 0) {
      const NearNodes pair = stack_.back();
      stack_.pop_back();
      spend(budget_, kNodesWork);
      if (!(pair.distance_squared <= bound_)) continue;
      const BvhNode &m = a_.bvh.nodes[pair.a], &n = b_.bvh.nodes[pair.b];
      if (m.is_leaf() && n.is_leaf()) {
        visit_leaves(m, n);
      } else if (n.is_leaf() || (!m.is_leaf() && size(m) >= size(n))) {
        push_two({m.first, pair.b}, {m.first + 1, pair.b});
      } else {
        push_two({pair.a, n.first}, {pair.a, n.first + 1});
      }
    }
    return result_;
  }

 private:
  static double size(const BvhNode& node) { return norm_squared(node.box.size()); }

  NearNodes make(std::uint32_t a, std::uint32_t b) const {
    return {box_distance_squared(a_.bvh.nodes[a].box, b_.bvh.nodes[b].box), a, b};
  }
  void push(std::uint32_t a, std::uint32_t b) { stack_.push_back(make(a, b)); }
  void push_two(std::pair<std::uint32_t, std::uint32_t> x, std::pair<std::uint32_t, std::uint32_t> y) {
    NearNodes first = make(x.first, x.second), second = make(y.first, y.second);
    if (first.distance_squared < second.distance_squared) std::swap(first, second);
    stack_.push_back(first);
    stack_.push_back(second);
  }

  void visit_leaves(const BvhNode& m, const BvhNode& n) {
    for (std::uint32_t k = m.first; k < m.first + m.count; ++k) {
      const std::uint32_t ta = a_.bvh.order[k];
      const Corners ca = corners(a_.mesh, ta);
      const Aabb box = box_at(a_.bvh, a_.mesh, k);
      const Beyond plane(ca);
      for (std::uint32_t l = n.first; l < n.first + n.count; ++l) {
        if (!(box_distance_squared(box, box_at(b_.bvh, b_.mesh, l)) <= bound_)) continue;
        spend(budget_, kBoxesWork);
        const std::uint32_t tb = b_.bvh.order[l];
        const Corners cb = corners(b_.mesh, tb);
        const double reach = std::sqrt(bound_) + rounding_;
        if (plane.holds(cb, reach) || Beyond(cb).holds(ca, reach)) continue;
        spend(budget_, kDistanceWork);
        const NearestPoints w = triangle_distance(ca, cb);
        const bool improves = w.distance_squared < bound_ ||
                              (w.distance_squared == bound_ && result_.triangle_a == kNoIndex);
        if (!improves || (counts_ && !counts_(ta, tb))) continue;
        bound_ = w.distance_squared;
        result_ = {std::sqrt(w.distance_squared), w.a, w.b, ta, tb};
      }
    }
  }

  const Surface& a_;
  const Surface& b_;
  const TrianglePairTest& counts_;
  Budget* budget_;
  double bound_;
  double rounding_ = 0;  // of a distance that is computed
  MeshDistance result_;
  std::vector<NearNodes> stack_;
};

MeshDistance distance_in_order(const Surface& a, const Surface& b, double limit, const TrianglePairTest& counts,
                               Budget* budget) {
  if (!counts) {
    if (const auto in_plane = prism_distance(a, b, limit)) return *in_plane;
  }
  return DistanceSearch(a, b, limit, counts, budget).run();
}

// Measured steps of two triangles in exact arithmetic.
constexpr std::uint64_t kComparisonWork = 10'000;

// Sign of (gap of the boxes along their widest axis - length). The triangles are at least that gap apart.
int compare_along_axes(const Aabb& a, const Aabb& b, double length) {
  int widest = -1;
  for (int axis = 0; axis < 3; ++axis) {
    for (const DoubleDouble gap : {exact_sum(a.min[axis], -b.max[axis]), exact_sum(b.min[axis], -a.max[axis])}) {
      const double beyond = gap.high != length ? gap.high - length : gap.low;
      widest = std::max(widest, beyond > 0 ? 1 : beyond < 0 ? -1 : 0);
    }
  }
  return widest;
}

// Float64 distances leave a few pairs of triangles whose distance is about the length. Exact signs decide these.
class GapComparison {
 public:
  GapComparison(const Surface& a, const Surface& b, double length, const Poll& poll)
      : a_(a), b_(b), length_(length), budget_(budget_of_pair(a.mesh, b.mesh, poll)) {}

  int sign() {
    const Aabb &box_a = a_.bvh.nodes[0].box, &box_b = b_.bvh.nodes[0].box;
    const double largest = larger(box_a.largest_coordinate(), box_b.largest_coordinate());
    // Records no nearest pair, so that the traversal visits every pair within the limit, or ends at one that settles it.
    mesh_distance(a_, b_, length_ + 2 * chain_rounding(largest), [this](std::uint32_t t, std::uint32_t u) {
      include(t, u);
      return least_ < 0;
    }, &budget_);
    return least_;
  }

 private:
  void include(std::uint32_t t, std::uint32_t u) {
    const Corners of_a = corners(a_.mesh, t), of_b = corners(b_.mesh, u);
    if (least_ < 0 || compare_along_axes(bounds_of(of_a), bounds_of(of_b), length_) >= least_) return;
    budget_.spend(kComparisonWork);
    const std::vector<Vec3> points_a(of_a.begin(), of_a.end()), points_b(of_b.begin(), of_b.end());
    const int sign = compare_distance(ExactDifference(points_a, points_b), length_);
    least_ = std::min(least_, sign);
  }

  const Surface &a_, &b_;
  double length_;
  Budget budget_;
  int least_ = 1;
};

}  // namespace

MeshDistance mesh_distance(const Surface& a, const Surface& b, double limit, const TrianglePairTest& counts,
                           Budget* budget) {
  if (!(limit >= 0)) throw std::invalid_argument("the distance limit must not be negative");
  if (comes_before(a, b)) return distance_in_order(a, b, limit, counts, budget);
  TrianglePairTest mirrored;
  if (counts) mirrored = [&](std::uint32_t t, std::uint32_t u) { return counts(u, t); };
  MeshDistance distance = distance_in_order(b, a, limit, mirrored, budget);
  std::swap(distance.witness_a, distance.witness_b);
  std::swap(distance.triangle_a, distance.triangle_b);
  return distance;
}

int compare_gap(const Surface& a, const Surface& b, double length, const Poll& poll) {
  return GapComparison(a, b, length, poll).sign();
}

}  // namespace satcheck
