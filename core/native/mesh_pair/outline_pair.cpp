// Edges that cross show an overlap. If none do, every place where the outlines meet is a corner of one of them, and
// corners cut the edges into pieces. The interiors meet exactly if a piece of one outline lies inside the other, or if
// both outlines have a common piece with the material on the same side. Pieces that are connected without a place of
// contact lie on one side, so an outline without contact needs one test for each loop.

#include "mesh_pair/outline_pair.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "exact/predicates.hpp"
#include "exact/triangle_distance.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/outline.hpp"
#include "mesh_pair/contact.hpp"

namespace satcheck {
namespace {

struct EdgePair {
  std::uint32_t own, other;
};

struct InsidePiece {
  EdgePair edges;
  Vec2 middle;  // rounded
};

// The pieces of one outline, against the other one.
class OutlineSide {
 public:
  OutlineSide(const Outline& self, const Outline& other, std::vector<EdgePair> contacts)
      : self_(self), other_(other), contacts_(std::move(contacts)) {
    std::sort(contacts_.begin(), contacts_.end(), [](EdgePair p, EdgePair q) { return p.own < q.own; });
  }

  // A piece of an edge in contact that is inside the other outline, or along it with the material on the same side.
  std::optional<InsidePiece> piece_inside() const {
    for (std::size_t first = 0; first < contacts_.size();) {
      std::size_t last = first;
      while (last < contacts_.size() && contacts_[last].own == contacts_[first].own) ++last;
      if (const auto middle = middle_inside(first, last)) return InsidePiece{contacts_[first], *middle};
      first = last;
    }
    return std::nullopt;
  }

  // The first edges of the loops without contact that are inside the other outline.
  std::vector<std::uint32_t> loops_inside() const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t loop : self_.loops) {
      const Vec2 corner = self_.edges[loop].from;
      if (!in_contact(loop) && other_.holds({corner, corner})) found.push_back(loop);
    }
    return found;
  }

 private:
  // Edges of a loop are neighbours in the order, because the loop was added as a whole.
  bool in_contact(std::uint32_t loop) const {
    const auto next_loop = std::upper_bound(self_.loops.begin(), self_.loops.end(), loop);
    const auto end = next_loop == self_.loops.end() ? static_cast<std::uint32_t>(self_.edges.size()) : *next_loop;
    const auto found = std::lower_bound(contacts_.begin(), contacts_.end(), loop,
                                        [](EdgePair c, std::uint32_t edge) { return c.own < edge; });
    return found != contacts_.end() && found->own < end;
  }

  // Of one edge, with the contacts first, ..., last - 1.
  std::optional<Vec2> middle_inside(std::size_t first, std::size_t last) const {
    const OutlineEdge& e = self_.edges[contacts_[first].own];
    std::vector<Vec2>& cuts = cuts_;
    cuts.assign({e.from, e.to});
    for (std::size_t c = first; c < last; ++c) {
      const OutlineEdge& f = other_.edges[contacts_[c].other];
      for (Vec2 p : {f.from, f.to}) {
        if (orientation(e.from, e.to, p) == 0 && is_between(e, p)) cuts.push_back(p);
      }
    }
    // Along an edge, points are in the order of a coordinate that changes.
    const bool by_x = e.from.x != e.to.x;
    std::sort(cuts.begin(), cuts.end(), [&](Vec2 p, Vec2 q) { return by_x ? p.x < q.x : p.y < q.y; });
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      const Vec2 p = cuts[k], q = cuts[k + 1];
      if (p.x == q.x && p.y == q.y) continue;
      if (is_inside(e, {p, q}, first, last)) return p + (q - p) * 0.5;
    }
    return std::nullopt;
  }

  bool is_inside(const OutlineEdge& e, MiddlePoint piece, std::size_t first, std::size_t last) const {
    for (std::size_t c = first; c < last; ++c) {
      const OutlineEdge& f = other_.edges[contacts_[c].other];
      const bool on_line = orientation(e.from, e.to, f.from) == 0 && orientation(e.from, e.to, f.to) == 0;
      if (on_line && is_between(f, piece.p) && is_between(f, piece.q)) return same_direction(e, f);
    }
    return other_.holds(piece);
  }

  // For points and edges on one line.
  static bool is_between(const OutlineEdge& e, Vec2 p) {
    return std::min(e.from.x, e.to.x) <= p.x && p.x <= std::max(e.from.x, e.to.x) &&
           std::min(e.from.y, e.to.y) <= p.y && p.y <= std::max(e.from.y, e.to.y);
  }
  static bool same_direction(const OutlineEdge& e, const OutlineEdge& f) {
    return e.from.x != e.to.x ? (e.from.x < e.to.x) == (f.from.x < f.to.x) : (e.from.y < e.to.y) == (f.from.y < f.to.y);
  }

  const Outline &self_, &other_;
  std::vector<EdgePair> contacts_;  // by own edge
  mutable std::vector<Vec2> cuts_;  // of one edge, kept for its memory
};

struct Meeting {
  std::optional<EdgePair> crossing;
  std::vector<EdgePair> contacts;  // if there is no crossing
  std::size_t tests = 0;
};

Meeting find_meeting(const Outline& a, const Outline& b) {
  Meeting meeting;
  auto visit = [&](std::uint32_t i, std::uint32_t k) {
    ++meeting.tests;
    switch (classify(a.edges[i], b.edges[k])) {
      case EdgeContact::crossing:
        meeting.crossing = {i, k};
        return false;
      case EdgeContact::touching:
        meeting.contacts.push_back({i, k});
        return true;
      default:
        return true;
    }
  };
  visit_meeting_edges(a, a.root(), b, b.root(), visit);
  return meeting;
}

MeshRelation make_relation(Relation relation, std::uint32_t wall_a, std::uint32_t wall_b, std::optional<Vec3> point) {
  MeshRelation result;
  result.relation = relation;
  result.triangle_a = wall_a;
  result.triangle_b = wall_b;
  result.point = point;
  return result;
}

// Two prisms across one axis, of different heights.
class PrismPair {
 public:
  PrismPair(const Surface& a, const Surface& b, const Outline& in_a, const Outline& in_b)
      : a_(a), b_(b), in_a_(in_a), in_b_(in_b) {}

  MeshRelation relation() const {
    const Meeting meeting = find_meeting(in_a_, in_b_);
    MeshRelation result = relation_of(meeting);
    result.edge_tests = meeting.tests;
    return result;
  }

 private:
  MeshRelation relation_of(const Meeting& meeting) const {
    if (meeting.crossing) return where_walls(*meeting.crossing, TriangleContact::crossing);
    const OutlineSide side_a(in_a_, in_b_, meeting.contacts), side_b(in_b_, in_a_, mirrored(meeting.contacts));
    if (const auto piece = side_a.piece_inside()) return at_piece(piece->edges, piece->middle);
    if (const auto piece = side_b.piece_inside()) return at_piece(mirrored(piece->edges), piece->middle);
    const auto of_a = side_a.loops_inside(), of_b = side_b.loops_inside();
    if (!of_a.empty() || !of_b.empty()) return nested(of_a, of_b, meeting.contacts.empty());
    if (meeting.contacts.empty()) return {};
    return where_walls(meeting.contacts[0], TriangleContact::touching);
  }

  static EdgePair mirrored(EdgePair c) { return {c.other, c.own}; }
  static std::vector<EdgePair> mirrored(std::vector<EdgePair> contacts) {
    for (EdgePair& c : contacts) c = mirrored(c);
    return contacts;
  }

  MeshRelation at_piece(EdgePair edges, Vec2 middle) const {
    const std::uint32_t wall_a = in_a_.edges[edges.own].wall[0], wall_b = in_b_.edges[edges.other].wall[0];
    return make_relation(Relation::penetrating, wall_a, wall_b, in_space(middle, in_a_.axis));
  }

  // Loops of each outline are inside the other one. A prism that is lower in both senses is inside.
  MeshRelation nested(const std::vector<std::uint32_t>& of_a, const std::vector<std::uint32_t>& of_b, bool no_contact) const {
    const bool b_within = no_contact && of_a.empty() && of_b.size() == in_b_.loops.size();
    const bool a_within = no_contact && of_b.empty() && of_a.size() == in_a_.loops.size();
    const Relation relation = b_within && in_b_.height < in_a_.height   ? Relation::contains
                              : a_within && in_a_.height < in_b_.height ? Relation::inside
                                                                        : Relation::penetrating;
    const bool inner_b = !of_b.empty();
    const OutlineEdge& edge = inner_b ? in_b_.edges[of_b[0]] : in_a_.edges[of_a[0]];
    return make_relation(relation, inner_b ? kNoIndex : edge.wall[0], inner_b ? edge.wall[0] : kNoIndex,
                         in_space(edge.from, in_a_.axis));
  }

  // Two walls have two triangles each, and some of these cross or touch.
  MeshRelation where_walls(EdgePair edges, TriangleContact wanted) const {
    const bool cross = wanted == TriangleContact::crossing;
    const Relation relation = cross ? Relation::penetrating : Relation::touching;
    const OutlineEdge &e = in_a_.edges[edges.own], &f = in_b_.edges[edges.other];
    for (const std::uint32_t t : e.wall) {
      for (const std::uint32_t u : f.wall) {
        const Corners of_a = corners(a_.mesh, t), of_b = corners(b_.mesh, u);
        if (classify(of_a, of_b) != wanted) continue;
        return make_relation(relation, t, u, cross ? crossing_point(of_a, of_b) : contact_point(of_a, of_b));
      }
    }
    return make_relation(relation, e.wall[0], f.wall[0], std::nullopt);
  }

  const Surface &a_, &b_;
  const Outline &in_a_, &in_b_;
};

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

struct OutlineNodes {
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
      const OutlineNodes pair = stack_.back();
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
  std::vector<OutlineNodes> stack_;
};

// The triangle of the wall that is nearer to the point.
std::uint32_t wall_at(const Surface& surface, const OutlineEdge& e, Vec3 p) {
  const auto off = [&](std::uint32_t t) { return norm_squared(nearest_on_triangle(p, corners(surface.mesh, t)) - p); };
  return off(e.wall[1]) < off(e.wall[0]) ? e.wall[1] : e.wall[0];
}

}  // namespace

std::optional<MeshRelation> prism_relation(const Surface& a, const Surface& b) {
  const Outline *const in_a = outline_of(a), *const in_b = in_a ? outline_of(b) : nullptr;
  if (!in_a || !in_b || in_a->axis != in_b->axis || in_a->height == in_b->height) return std::nullopt;
  return PrismPair(a, b, *in_a, *in_b).relation();
}

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
