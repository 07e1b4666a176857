// A tree of axis-aligned boxes over the triangles of a mesh.
#pragma once

#include <vector>

#include "base/budget.hpp"
#include "base/mesh.hpp"

namespace satcheck {

struct BvhNode {
  Aabb box;
  std::uint32_t first = 0;  // leaf: place in `order`; inner: the left child; the right child follows
  std::uint32_t count = 0;  // triangles of a leaf, 0 for an inner node

  bool is_leaf() const { return count != 0; }
};

struct Bvh {
  std::vector<BvhNode> nodes;        // nodes[0] is the root; empty for an empty mesh
  std::vector<std::uint32_t> order;  // triangle numbers, leaves hold ranges of them
  std::vector<Aabb> boxes;           // of these triangles; may be missing for the last ones
};

// The tree does not depend on the number of threads; 0: one for each core.
Bvh build_bvh(const Mesh& mesh, unsigned threads = 0);

// The same, refined only where boxes of triangles meet `region`. All other triangles lie in at most six leaves, each
// beyond one side of the region, without boxes. A query within the region does not visit these leaves.
Bvh build_bvh_near(const Mesh& mesh, const Aabb& region, unsigned threads = 0);

// A tree over boxes of any size instead of triangles. Long and flat boxes go into separate subtrees, one for each
// direction. Otherwise crossing beams along x and y would share leaves, and the boxes of these leaves would be as large
// as the whole scaffold.
Bvh build_bvh_by_form(const std::vector<Aabb>& boxes, unsigned threads = 0);

// The numbers of the boxes along a curve on which neighbours are close to each other.
std::vector<std::uint32_t> order_along_curve(const std::vector<Aabb>& boxes);

// Fits the boxes to moved triangles, in linear time. The tree keeps its structure. It is as good as a new one if
// neighbours stay neighbours, as under an affine map.
void refit(Bvh& bvh, const Mesh& mesh);

inline Aabb triangle_box(const Mesh& mesh, std::uint32_t t) { return bounds_of(corners(mesh, t)); }

// The box of the triangle at a place in `order`.
inline Aabb box_at(const Bvh& bvh, const Mesh& mesh, std::uint32_t place) {
  return place < bvh.boxes.size() ? bvh.boxes[place] : triangle_box(mesh, bvh.order[place]);
}

// Measured steps of a visit to a node.
inline constexpr std::uint64_t kNodeWork = 10;

// Few trees are deeper.
inline constexpr std::size_t kUsualDepth = 48;

// Calls visit(triangle) -> bool for every triangle whose box `meets`, until one returns false. meets(box) is true for
// each box that holds such a box. Returns whether all were visited.
template <class Meets, class Visit>
bool visit_where(const Bvh& bvh, const Mesh& mesh, Meets meets, Visit visit, Budget* budget = nullptr) {
  if (bvh.nodes.empty()) return true;
  std::vector<std::uint32_t> stack;
  stack.reserve(kUsualDepth);
  stack.push_back(0);
  while (!stack.empty()) {
    const BvhNode& node = bvh.nodes[stack.back()];
    stack.pop_back();
    spend(budget, kNodeWork);
    if (!meets(node.box)) continue;
    if (!node.is_leaf()) {
      stack.push_back(node.first + 1);
      stack.push_back(node.first);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (meets(box_at(bvh, mesh, i)) && !visit(bvh.order[i])) return false;
    }
  }
  return true;
}

// The triangles whose box meets `query`.
template <class Visit>
bool visit_box(const Bvh& bvh, const Mesh& mesh, const Aabb& query, Visit visit, Budget* budget = nullptr) {
  return visit_where(bvh, mesh, [&](const Aabb& box) { return meet(box, query); }, visit, budget);
}

}  // namespace satcheck
