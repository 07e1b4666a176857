// The outline of a prism: a mesh between two planes across an axis, at -height and +height, with walls along the axis. What
// prisms of different heights have in common is what their outlines have in common, so two dimensions are enough.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mesh/surface.hpp"

namespace satcheck {

struct OutlineEdge {
  Vec2 from, to;          // material on the left, seen against the axis
  std::uint32_t next;     // the edge that starts where this one ends
  std::uint32_t wall[2];  // its triangles in the mesh
};

struct OutlineBox {
  Vec2 low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
};

inline bool meet(const OutlineBox& a, const OutlineBox& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

inline OutlineBox box_of(const OutlineEdge& e) {
  return {{smaller(e.from.x, e.to.x), smaller(e.from.y, e.to.y)}, {larger(e.from.x, e.to.x), larger(e.from.y, e.to.y)}};
}

// The point in the middle between two points, without rounding.
struct MiddlePoint {
  Vec2 p, q;
};

// A node of the tree over the edges, which are in the order of the loops, so that halves of a range lie together.
struct OutlineNode {
  std::uint32_t index, first, last;  // the edges first, ..., last - 1

  static constexpr std::uint32_t kLeaf = 4;
  bool is_leaf() const { return last - first <= kLeaf; }
  std::uint32_t size() const { return last - first; }
  OutlineNode half(bool second) const {
    const std::uint32_t middle = (first + last) / 2;
    return {2 * index + second, second ? middle : first, second ? last : middle};
  }
};

// Simple loops without common points, with material on one side of each.
class Outline {
 public:
  int axis = 2;
  double height = 0;
  std::vector<OutlineEdge> edges;        // loop by loop
  std::vector<std::uint32_t> loops;  // their first edges
  std::vector<OutlineBox> boxes;         // by the index of a node

  OutlineNode root() const { return {1, 0, static_cast<std::uint32_t>(edges.size())}; }
  // Whether a point that is on no edge is in the material.
  bool holds(MiddlePoint point) const { return winding(root(), point) != 0; }
  int winding(const OutlineNode& node, const MiddlePoint& point) const;
};

// +1 for a point on the left of a line, exactly.
int side_of(Vec2 from, Vec2 to, const MiddlePoint& point);

enum class EdgeContact { none, touching, crossing };

// Two closed edges. crossing: in one inner point of both. touching: in any other way.
EdgeContact classify(const OutlineEdge& e, const OutlineEdge& f);

// Calls visit(i, k) for all edges i of a and k of b whose boxes meet, until it returns false.
template <class Visit>
bool visit_meeting_edges(const Outline& a, const OutlineNode& m, const Outline& b, const OutlineNode& n, Visit& visit) {
  if (!meet(a.boxes[m.index], b.boxes[n.index])) return true;
  if (m.is_leaf() && n.is_leaf()) {
    for (std::uint32_t i = m.first; i < m.last; ++i) {
      for (std::uint32_t k = n.first; k < n.last; ++k) {
        if (meet(box_of(a.edges[i]), box_of(b.edges[k])) && !visit(i, k)) return false;
      }
    }
    return true;
  }
  const bool split_a = n.is_leaf() || (!m.is_leaf() && m.size() >= n.size());
  for (const bool second : {false, true}) {
    if (!(split_a ? visit_meeting_edges(a, m.half(second), b, n, visit)
                  : visit_meeting_edges(a, m, b, n.half(second), visit))) {
      return false;
    }
  }
  return true;
}

// The point of a prism half way up: at 0 across the plane.
inline Vec3 in_space(Vec2 p, int axis) { return axis == 2 ? Vec3{p.x, p.y, 0} : axis == 0 ? Vec3{0, p.x, p.y} : Vec3{p.y, 0, p.x}; }

// Null if the surface is not such a prism, or if it has no place for an outline. Also for a prism that is wider than
// high: those of checks in a plane are high, and bodies in space are compared as meshes. Made once.
const Outline* outline_of(const Surface& surface);

}  // namespace satcheck
