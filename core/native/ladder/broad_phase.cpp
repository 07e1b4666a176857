// Method: one tree over all boxes, walked against itself: Gottschalk, Lin, Manocha, "OBBTree: A
// Hierarchical Structure for Rapid Interference Detection" (1996), the simultaneous descent, on the tree of
// bvh.cpp. Unlike a sweep along an axis, it takes time near n log n if there are few pairs. Each box is grown outward
// by its reach, so that the walk misses no pair. The gap of the boxes themselves then decides.
#include "ladder/broad_phase.hpp"

#include <algorithm>
#include <utility>

#include "base/rounding.hpp"
#include "ladder/world_box.hpp"
#include "mesh/bvh.hpp"

namespace satcheck {
namespace {

// Contains every point within `reach` of the box, rounding included; also if two reaches are summed first.
Aabb grown(const Aabb& box, double reach) {
  const double by = reach * (1 + 4 * kUnitRoundoff);
  const auto below = [&](double c) { return std::nextafter(c - by, -INFINITY); };
  const auto above = [&](double c) { return std::nextafter(c + by, INFINITY); };
  return {{below(box.min.x), below(box.min.y), below(box.min.z)},
          {above(box.max.x), above(box.max.y), above(box.max.z)}};
}

double half_area(const Aabb& box) {
  const Vec3 e = box.max - box.min;
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

// A set of pairs, with fast look-ups.
class PairSet {
 public:
  explicit PairSet(std::vector<IndexPair> pairs) : pairs_(std::move(pairs)) {
    std::sort(pairs_.begin(), pairs_.end());
  }
  bool holds(std::uint32_t i, std::uint32_t j) const {
    return !pairs_.empty() && std::binary_search(pairs_.begin(), pairs_.end(), IndexPair{std::min(i, j), std::max(i, j)});
  }

 private:
  std::vector<IndexPair> pairs_;
};

class SelfTraversal {
 public:
  explicit SelfTraversal(CloseQuery query)
      : boxes_(std::move(query.boxes)), reach_(std::move(query.reach)), kind_(std::move(query.kind)),
        exempt_kinds_(std::move(query.exempt_kinds)), exempt_(std::move(query.exempt)) {
    std::vector<Aabb> reached(boxes_.size());
    for (std::size_t i = 0; i < boxes_.size(); ++i) reached[i] = grown(boxes_[i], reach_[i]);
    bvh_ = build_bvh_by_form(reached);
    find_node_kinds();
  }

  std::vector<IndexPair> run() {
    if (bvh_.nodes.empty()) return {};
    std::vector<IndexPair> stack{{0, 0}};
    while (!stack.empty()) {
      const auto [i, j] = stack.back();
      stack.pop_back();
      const BvhNode &m = bvh_.nodes[i], &n = bvh_.nodes[j];
      if (!meet(m.box, n.box) || are_exempt(node_kind_[i], node_kind_[j])) continue;
      if (i == j && m.is_leaf()) {
        test_within(m);
      } else if (i == j) {
        stack.insert(stack.end(), {{m.first, m.first}, {m.first + 1, m.first + 1}, {m.first, m.first + 1}});
      } else if (m.is_leaf() && n.is_leaf()) {
        test_leaves(m, n);
      } else if (n.is_leaf() || (!m.is_leaf() && half_area(m.box) >= half_area(n.box))) {
        stack.insert(stack.end(), {{m.first, j}, {m.first + 1, j}});
      } else {
        stack.insert(stack.end(), {{i, n.first}, {i, n.first + 1}});
      }
    }
    std::sort(pairs_.begin(), pairs_.end());
    return std::move(pairs_);
  }

 private:
  static constexpr std::uint32_t kMixed = 0xFFFFFFFF;

  bool are_exempt(std::uint32_t kind_a, std::uint32_t kind_b) const {
    return kind_a != kMixed && kind_b != kMixed && exempt_kinds_.holds(kind_a, kind_b);
  }

  // The kind of all boxes below each node. Children come after their parents.
  void find_node_kinds() {
    node_kind_.resize(bvh_.nodes.size());
    for (std::size_t k = bvh_.nodes.size(); k-- > 0;) {
      const BvhNode& node = bvh_.nodes[k];
      if (node.is_leaf()) {
        node_kind_[k] = kind_[bvh_.order[node.first]];
        for (std::uint32_t i = node.first + 1; i < node.first + node.count; ++i) {
          if (kind_[bvh_.order[i]] != node_kind_[k]) node_kind_[k] = kMixed;
        }
      } else {
        const std::uint32_t left = node_kind_[node.first], right = node_kind_[node.first + 1];
        node_kind_[k] = left == right ? left : kMixed;
      }
    }
  }

  void test_within(const BvhNode& leaf) {
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.count; ++k) {
      for (std::uint32_t l = k + 1; l < leaf.first + leaf.count; ++l) test(k, l);
    }
  }

  void test_leaves(const BvhNode& m, const BvhNode& n) {
    for (std::uint32_t k = m.first; k < m.first + m.count; ++k) {
      if (!meet(bvh_.boxes[k], n.box)) continue;
      for (std::uint32_t l = n.first; l < n.first + n.count; ++l) test(k, l);
    }
  }

  void test(std::uint32_t k, std::uint32_t l) {
    if (!meet(bvh_.boxes[k], bvh_.boxes[l])) return;
    const std::uint32_t i = bvh_.order[k], j = bvh_.order[l];
    if (!(box_gap(boxes_[i], boxes_[j]) <= reach_[i] + reach_[j])) return;
    if (exempt_kinds_.holds(kind_[i], kind_[j]) || exempt_.holds(i, j)) return;
    pairs_.push_back({std::min(i, j), std::max(i, j)});
  }

  const std::vector<Aabb> boxes_;
  const std::vector<double> reach_;
  const std::vector<std::uint32_t> kind_;
  const PairSet exempt_kinds_, exempt_;
  Bvh bvh_;
  std::vector<std::uint32_t> node_kind_;
  std::vector<IndexPair> pairs_;
};

}  // namespace

std::vector<IndexPair> close_pairs(CloseQuery query) { return SelfTraversal(std::move(query)).run(); }

}  // namespace satcheck
