#include "mesh_pair/mesh_distance.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "exact/triangle_distance.hpp"

namespace satcheck {
namespace {

struct NodePair {
  double distance_squared;
  std::uint32_t a, b;
};

class DistanceSearch {
 public:
  DistanceSearch(const Surface& a, const Surface& b, double limit, const TrianglePairTest& counts)
      : a_(a), b_(b), counts_(counts), bound_(limit * limit) {}

  MeshDistance run() {
    if (a_.bvh.nodes.empty() || b_.bvh.nodes.empty()) return result_;
    push(0, 0);
    // Depth first, the nearer child first: the bound gets good early and the stack stays short.
    while (!stack_.empty() && result_.distance > 0) {
      const NodePair pair = stack_.back();
      stack_.pop_back();
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
  static double size(const BvhNode& node) { return norm_squared(node.box.max - node.box.min); }

  NodePair make(std::uint32_t a, std::uint32_t b) const {
    return {box_distance_squared(a_.bvh.nodes[a].box, b_.bvh.nodes[b].box), a, b};
  }
  void push(std::uint32_t a, std::uint32_t b) { stack_.push_back(make(a, b)); }
  void push_two(std::pair<std::uint32_t, std::uint32_t> x, std::pair<std::uint32_t, std::uint32_t> y) {
    NodePair first = make(x.first, x.second), second = make(y.first, y.second);
    if (first.distance_squared < second.distance_squared) std::swap(first, second);
    stack_.push_back(first);
    stack_.push_back(second);
  }

  void visit_leaves(const BvhNode& m, const BvhNode& n) {
    for (std::uint32_t k = m.first; k < m.first + m.count; ++k) {
      const std::uint32_t ta = a_.bvh.order[k];
      const Corners ca = corners(a_.mesh, ta);
      const Aabb box = box_at(a_.bvh, a_.mesh, k);
      for (std::uint32_t l = n.first; l < n.first + n.count; ++l) {
        if (!(box_distance_squared(box, box_at(b_.bvh, b_.mesh, l)) <= bound_)) continue;
        const std::uint32_t tb = b_.bvh.order[l];
        const Witnesses w = triangle_distance(ca, corners(b_.mesh, tb));
        const bool improves = w.distance_squared < bound_ ||
                              (w.distance_squared == bound_ && result_.triangle_a == kNoTriangle);
        if (!improves || (counts_ && !counts_(ta, tb))) continue;
        bound_ = w.distance_squared;
        result_ = {std::sqrt(w.distance_squared), w.a, w.b, ta, tb};
      }
    }
  }

  const Surface& a_;
  const Surface& b_;
  const TrianglePairTest& counts_;
  double bound_;
  MeshDistance result_;
  std::vector<NodePair> stack_;
};

}  // namespace

MeshDistance mesh_distance(const Surface& a, const Surface& b, double limit, const TrianglePairTest& counts) {
  if (!(limit >= 0)) throw std::invalid_argument("the distance limit must not be negative");
  return DistanceSearch(a, b, limit, counts).run();
}

}  // namespace satcheck
