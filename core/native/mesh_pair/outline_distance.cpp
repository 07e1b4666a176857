#include "mesh_pair/outline_distance.hpp"

#include <utility>
#include <vector>

#include "exact/predicates.hpp"
#include "exact/triangle_distance.hpp"
#include "mesh/outline.hpp"

namespace satcheck {
namespace {

double squared_distance(const OutlineBox& a, const OutlineBox& b) {
  const auto gap = [](double low_a, double high_a, double low_b, double high_b) {
    return larger(0, larger(low_b - high_a, low_a - high_b));
  };
  const double x = gap(a.low.x, a.high.x, b.low.x, b.high.x), y = gap(a.low.y, a.high.y, b.low.y, b.high.y);
  return x * x + y * y;
}

// The point of the edge that is nearest to p.
Vec2 nearest_on_edge(const OutlineEdge& e, Vec2 p) {
  const Vec2 along = e.to - e.from;
  const double way = dot(along, p - e.from), length = dot(along, along);
  return !(way > 0) ? e.from : !(way < length) ? e.to : e.from + along * (way / length);
}

// A corner of edges that touch, on both of them.
Vec2 common_corner(const OutlineEdge& e, const OutlineEdge& f) {
  const auto lies_on = [](Vec2 p, const OutlineEdge& edge) {
    return orientation(edge.from, edge.to, p) == 0 && meet(OutlineBox{p, p}, box_of(edge));
  };
  return lies_on(f.from, e) ? f.from : lies_on(f.to, e) ? f.to : lies_on(e.from, f) ? e.from : e.to;
}

struct NodePair {
  double squared;
  OutlineNode a, b;
};

// Depth first, nearer half first, as in mesh_distance().
class OutlineSearch {
 public:
  OutlineSearch(const Outline& a, const Outline& b, double limit) : a_(a), b_(b), least_(limit * limit) {}

  // False if the outlines cross.
  bool run() {
    push(a_.root(), b_.root());
    while (!stack_.empty() && least_ > 0) {
      const NodePair pair = stack_.back();
      stack_.pop_back();
      if (!(pair.squared <= least_)) continue;
      const OutlineNode &m = pair.a, &n = pair.b;
      if (m.is_leaf() && n.is_leaf()) {
        if (!visit_leaves(m, n)) return false;
      } else if (n.is_leaf() || (!m.is_leaf() && m.size() >= n.size())) {
        push_nearer_last({m.half(false), n}, {m.half(true), n});
      } else {
        push_nearer_last({m, n.half(false)}, {m, n.half(true)});
      }
    }
    return true;
  }

  // Valid if any pair is within the limit.
  bool within() const { return found_; }
  double distance() const { return std::sqrt(least_); }
  Vec2 on_a, on_b;
  std::uint32_t edge_a = 0, edge_b = 0;

 private:
  using Nodes = std::pair<OutlineNode, OutlineNode>;

  double between(const Nodes& n) const { return squared_distance(a_.boxes[n.first.index], b_.boxes[n.second.index]); }
  void push(const OutlineNode& m, const OutlineNode& n) { stack_.push_back({between({m, n}), m, n}); }
  void push_nearer_last(Nodes first, Nodes second) {
    if (between(first) < between(second)) std::swap(first, second);
    push(first.first, first.second);
    push(second.first, second.second);
  }

  bool visit_leaves(const OutlineNode& m, const OutlineNode& n) {
    for (std::uint32_t i = m.first; i < m.last; ++i) {
      const OutlineEdge& e = a_.edges[i];
      for (std::uint32_t k = n.first; k < n.last; ++k) {
        const OutlineEdge& f = b_.edges[k];
        const double apart = squared_distance(box_of(e), box_of(f));
        const EdgeContact contact = apart == 0 ? classify(e, f) : EdgeContact::none;
        if (contact == EdgeContact::crossing) return false;
        if (contact == EdgeContact::touching) {
          const Vec2 corner = common_corner(e, f);
          offer(corner, corner, i, k);
        } else if (apart <= least_) {
          measure(i, k);
        }
      }
    }
    return true;
  }

  // Edges that do not meet are nearest at an end of one of them.
  void measure(std::uint32_t i, std::uint32_t k) {
    const OutlineEdge &e = a_.edges[i], &f = b_.edges[k];
    for (Vec2 p : {e.from, e.to}) offer(p, nearest_on_edge(f, p), i, k);
    for (Vec2 p : {f.from, f.to}) offer(nearest_on_edge(e, p), p, i, k);
  }
  void offer(Vec2 p, Vec2 q, std::uint32_t i, std::uint32_t k) {
    const double squared = dot(q - p, q - p);
    if (!(squared < least_) && (found_ || squared > least_)) return;
    least_ = squared;
    found_ = true;
    on_a = p, on_b = q, edge_a = i, edge_b = k;
  }

  const Outline &a_, &b_;
  double least_;
  bool found_ = false;
  std::vector<NodePair> stack_;
};

// The triangle of the wall that is nearer to the point.
std::uint32_t wall_at(const Surface& surface, const OutlineEdge& e, Vec3 p) {
  const auto off = [&](std::uint32_t t) { return norm_squared(nearest_on_triangle(p, corners(surface.mesh, t)) - p); };
  return off(e.wall[1]) < off(e.wall[0]) ? e.wall[1] : e.wall[0];
}

}  // namespace

std::optional<MeshDistance> prism_distance(const Surface& a, const Surface& b, double limit) {
  const Outline *const in_a = outline_of(a), *const in_b = in_a ? outline_of(b) : nullptr;
  if (!in_a || !in_b || in_a->axis != in_b->axis) return std::nullopt;
  const double ends_apart = std::fabs(in_a->height - in_b->height);
  OutlineSearch search(*in_a, *in_b, limit);
  if (!search.run() || !(smaller(search.distance(), limit) < ends_apart)) return std::nullopt;
  if (!search.within()) return MeshDistance{};
  const Vec3 on_a = in_space(search.on_a, in_a->axis), on_b = in_space(search.on_b, in_a->axis);
  return MeshDistance{search.distance(), on_a, on_b, wall_at(a, in_a->edges[search.edge_a], on_a),
                      wall_at(b, in_b->edges[search.edge_b], on_b)};
}

}  // namespace satcheck
