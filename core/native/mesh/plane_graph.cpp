#include "mesh/plane_graph.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "exact/predicates.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

// Measured steps of two segments that may meet, of a crossing with all that follows from it, of a stop with its share of
// the sort, of a half-edge, and of a half-edge that may pass a point.
constexpr std::uint64_t kPairWork = 20, kCrossingWork = 3000, kStopWork = 150, kHalfEdgeWork = 150, kPassWork = 10;

// Below this a rounded fraction may have lost digits.
constexpr double kSmallestFraction = 1e-200;

}  // namespace

PlaneGraph::PlaneGraph(const Corners& plane, Budget* budget)
    : plane_(plane), axis_(projection_axis(plane[0], plane[1], plane[2], budget)),
      turn_(orientation_2d(plane[0], plane[1], plane[2], axis_, budget)), budget_(budget) {}

void PlaneGraph::build() {
  meet_segments();
  for (Segment& s : segments_) sort_stops(s);
  cut_segments();
  trace();
  find_faces();
}

// Names of one point stay different nodes, as in the other planes that have them.
void PlaneGraph::build_named() {
  for (Segment& s : segments_) sort_stops(s);
  same_.clear();
  cut_segments();
  trace();
  find_faces();
}

std::uint32_t PlaneGraph::add_node(const LazyPoint& p) {
  nodes_.push_back(p);
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::uint32_t PlaneGraph::vertex(Vec3 p) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  const auto [known, is_new] = vertices_.try_emplace({p.x, p.y, p.z}, number);
  if (is_new) nodes_.emplace_back(p, Vec3{}, [this, number] { return make_exact_point(nodes_[number].rounded); });
  return known->second;
}

std::uint32_t PlaneGraph::piercing(Vec3 p, Vec3 q) {
  if (coordinates_less(q, p)) std::swap(p, q);
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  const auto known = piercings_.try_emplace({p.x, p.y, p.z, q.x, q.y, q.z}, number).first;
  if (known->second == number) {
    const std::array<double, 6>& key = known->first;
    nodes_.push_back(lazy_meeting_point(plane_, p, q, [this, &key] {
      return plane_meeting_point(plane_[0], plane_[1], plane_[2], {key[0], key[1], key[2]},
                                 {key[3], key[4], key[5]});
    }));
  }
  return known->second;
}

void PlaneGraph::add_segment(std::uint32_t from, std::uint32_t to, int surface, const PlaneChange& change) {
  if (from == to) return;
  const auto [known, is_new] = segment_of_.try_emplace(std::minmax(from, to), static_cast<std::uint32_t>(segments_.size()));
  if (is_new) segments_.push_back({std::min(from, to), std::max(from, to), {}, {}});
  segments_[known->second].changes[surface] += from < to ? change : -change;
}

void PlaneGraph::add_stop(std::uint32_t from, std::uint32_t to, std::uint32_t node) {
  segments_[segment_of_.at(std::minmax(from, to))].stops.push_back(node);
}

// Sweeps along the widest axis, where the fewest segments are near each other.
void PlaneGraph::meet_segments() {
  std::vector<Aabb> boxes;
  Aabb all;
  for (const Segment& s : segments_) {
    Aabb& box = boxes.emplace_back(point_box(nodes_[s.from]));
    box.include(point_box(nodes_[s.to]));
    all.include(box);
  }
  const int axis = all.widest_axis();
  std::vector<std::uint32_t> order(segments_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t k) {
    return boxes[i].min[axis] != boxes[k].min[axis] ? boxes[i].min[axis] < boxes[k].min[axis] : i < k;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Aabb& box = boxes[order[i]];
    std::size_t k = i + 1;
    for (; k < order.size() && boxes[order[k]].min[axis] <= box.max[axis]; ++k) {
      if (satcheck::meet(box, boxes[order[k]])) meet(order[i], order[k]);
    }
    spend(budget_, kPairWork * (k - i));
  }
}

void PlaneGraph::meet(std::uint32_t i, std::uint32_t k) {
  const Segment &s = segments_[i], &o = segments_[k];
  const auto side_of = [&](const Segment& line, std::uint32_t node) {
    return node == line.from || node == line.to ? 0 : side(line.from, line.to, nodes_[node]);
  };
  const int o_from = side_of(s, o.from), o_to = side_of(s, o.to);
  if (o_from * o_to > 0) return;
  if (o_from == 0 && o_to == 0) {
    for (const std::uint32_t node : {o.from, o.to}) stop_at(i, node);
    for (const std::uint32_t node : {s.from, s.to}) stop_at(k, node);
    return;
  }
  const int s_from = side_of(o, s.from), s_to = side_of(o, s.to);
  if (s_from * s_to > 0) return;
  const auto end = [](const Segment& of, int from, int to) { return from == 0 ? of.from : to == 0 ? of.to : kNoIndex; };
  std::uint32_t of_s = end(s, s_from, s_to), of_o = end(o, o_from, o_to);
  if (of_s != kNoIndex && of_o != kNoIndex) {
    if (of_s != of_o) same_.emplace_back(of_s, of_o);
  } else if (of_s != kNoIndex) {
    segments_[k].stops.push_back(of_s);
  } else if (of_o != kNoIndex) {
    segments_[i].stops.push_back(of_o);
  } else {
    spend(budget_, kCrossingWork);
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(lazy_crossing(nodes_[s.from], nodes_[s.to], nodes_[o.from], nodes_[o.to], axis_, [this, i, k] {
      const Segment &first = segments_[i], &second = segments_[k];
      return crossing_point(nodes_[first.from].exact(), nodes_[first.to].exact(), nodes_[second.from].exact(),
                            nodes_[second.to].exact(), axis_);
    }));
    segments_[i].stops.push_back(number);
    segments_[k].stops.push_back(number);
  }
}

// A node on the line of the segment.
void PlaneGraph::stop_at(std::uint32_t segment, std::uint32_t node) {
  Segment& s = segments_[segment];
  if (node == s.from || node == s.to) return;
  const int axis = axis_along(s), way = compare(s.to, s.from, axis);
  const int beyond = way * compare(node, s.from, axis);
  const int before = way * compare(s.to, node, axis);
  if (beyond == 0 || before == 0) same_.emplace_back(node, beyond == 0 ? s.from : s.to);
  if (beyond > 0 && before > 0) s.stops.push_back(node);
}

int PlaneGraph::axis_along(const Segment& s) const {
  const Vec3 way = nodes_[s.to].rounded - nodes_[s.from].rounded;
  const int widest = projection_axis(way);
  if (compare(s.to, s.from, widest) != 0) return widest;
  return compare(s.to, s.from, (widest + 1) % 3) != 0 ? (widest + 1) % 3 : (widest + 2) % 3;
}

void PlaneGraph::cut_segments() {
  DisjointSets names(nodes_.size()), parts(nodes_.size());
  for (const auto& [p, q] : same_) names.unite(p, q);
  for (std::uint32_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    std::uint32_t from = names.find(s.from);
    const auto go_to = [&](std::uint32_t node) {
      const std::uint32_t to = names.find(node);
      if (from == to) return;
      parts.unite(from, to);
      const bool forward = from < to;
      const PlaneChanges changes = forward ? s.changes : PlaneChanges{-s.changes[0], -s.changes[1]};
      edges_.push_back({std::min(from, to), std::max(from, to), i, forward, changes});
      from = to;
    };
    for (const std::uint32_t node : s.stops) go_to(node);
    go_to(s.to);
  }
  merge_edges();
  part_.resize(nodes_.size());
  for (std::uint32_t k = 0; k < part_.size(); ++k) part_[k] = parts.find(k);
}

void PlaneGraph::sort_stops(Segment& s) {
  spend(budget_, kStopWork * s.stops.size());
  const int axis = axis_along(s), way = compare(s.to, s.from, axis);
  std::sort(s.stops.begin(), s.stops.end(), [&](std::uint32_t p, std::uint32_t q) {
    const int order = p == q ? 0 : way * compare(p, q, axis);
    return order != 0 ? order < 0 : way > 0 ? p < q : q < p;
  });
  s.stops.erase(std::unique(s.stops.begin(), s.stops.end()), s.stops.end());
  for (std::size_t k = 1; k < s.stops.size(); ++k) {
    if (compare(s.stops[k - 1], s.stops[k], axis) == 0) same_.emplace_back(s.stops[k - 1], s.stops[k]);
  }
}

// Segments of one line may run along the same edge.
void PlaneGraph::merge_edges() {
  std::sort(edges_.begin(), edges_.end(), [](const Edge& e, const Edge& f) {
    return std::tie(e.low, e.high, e.segment) < std::tie(f.low, f.high, f.segment);
  });
  std::size_t count = 0;
  for (const Edge& edge : edges_) {
    if (count > 0 && edges_[count - 1].low == edge.low && edges_[count - 1].high == edge.high) {
      for (int k = 0; k < 2; ++k) edges_[count - 1].changes[k] += edge.changes[k];
    } else {
      edges_[count++] = edge;
    }
  }
  edges_.resize(count);
}

// The end of the segment ahead of a half-edge: it has fewer digits than the next node.
std::uint32_t PlaneGraph::far_end(std::uint32_t h) const {
  const Edge& edge = edges_[h / 2];
  const Segment& s = segments_[edge.segment];
  return edge.forward == (h % 2 == 0) ? s.to : s.from;
}

PlaneChanges PlaneGraph::changes(std::uint32_t h) const {
  const PlaneChanges& changes = edges_[h / 2].changes;
  return h % 2 == 0 ? changes : PlaneChanges{-changes[0], -changes[1]};
}

void PlaneGraph::trace() {
  const auto half_edges = static_cast<std::uint32_t>(2 * edges_.size());
  spend(budget_, kHalfEdgeWork * half_edges);
  std::vector<std::uint32_t> leaving(half_edges);
  std::iota(leaving.begin(), leaving.end(), 0u);
  std::sort(leaving.begin(), leaving.end(), [&](std::uint32_t g, std::uint32_t h) {
    return start(g) != start(h) ? start(g) < start(h) : g < h;
  });
  next_.resize(half_edges);
  std::vector<std::uint32_t> around;
  for (std::size_t i = 0; i < leaving.size();) {
    around.clear();
    for (const std::uint32_t from = start(leaving[i]); i < leaving.size() && start(leaving[i]) == from; ++i) {
      around.push_back(leaving[i]);
    }
    if (around.size() > 2) sort_around(around);
    for (std::size_t k = 0; k < around.size(); ++k) {
      next_[around[k] ^ 1] = around[(k + around.size() - 1) % around.size()];
    }
  }
  outline_.assign(half_edges, kNoIndex);
  for (std::uint32_t h = 0; h < half_edges; ++h) {
    if (outline_[h] != kNoIndex) continue;
    boxes_.emplace_back();
    for (std::uint32_t g = h; outline_[g] == kNoIndex; g = next_[g]) {
      outline_[g] = static_cast<std::uint32_t>(first_.size());
      boxes_.back().include(point_box(nodes_[start(g)]));
    }
    first_.push_back(h);
  }
}

void PlaneGraph::find_faces() {
  DisjointSets sets(first_.size());
  const auto in_first_part = [&](std::uint32_t h) { return part_[start(h)] == part_[start(0)]; };
  if (!std::all_of(first_.begin(), first_.end(), in_first_part)) join_outlines(sets);
  std::vector<std::uint32_t> number(first_.size());
  for (std::uint32_t k = 0; k < first_.size(); ++k) {
    const std::uint32_t set = sets.find(k);
    if (set == k) {
      number[k] = face_count();
      outlines_.emplace_back();
    }
    face_.push_back(number[set]);
    outlines_[number[set]].push_back(k);
  }
}

// The outline around a part of the graph has the face outside of that part on its left. It passes the first node of the
// part along the plane's first axis, then its second one, and leaves it by the last half-edge, counter-clockwise: those
// that leave this node lie within half a turn.
void PlaneGraph::join_outlines(DisjointSets& sets) const {
  const auto [i, j] = plane_axes(axis_);
  // Named anew: clang before 16 captures no binding.
  const auto is_before = [&, i = i, j = j](std::uint32_t p, std::uint32_t q) {
    const int along = compare(p, q, i);
    return along != 0 ? along < 0 : compare(p, q, j) < 0;
  };
  std::vector<std::uint32_t> last(nodes_.size(), kNoIndex);  // by part: the half-edge with the outside on its left
  for (std::uint32_t h = 0; h < half_edge_count(); ++h) {
    const std::uint32_t at = start(h);
    std::uint32_t& known = last[part_[at]];
    const bool is_later = known != kNoIndex && at == start(known) && side(at, far_end(known), nodes_[far_end(h)]) > 0;
    if (known == kNoIndex || is_later || (at != start(known) && is_before(at, start(known)))) known = h;
  }
  // Parts with nodes of different names may touch: then a point beside the half-edge tells.
  std::vector<std::uint32_t> nodes(nodes_.size());
  std::iota(nodes.begin(), nodes.end(), 0u);
  const auto around_part = [&](std::uint32_t h) {
    if (const auto around = outline_around(nodes_[start(h)], part_[start(h)])) return *around;
    const auto p = inside_left_of(h, nodes, 0);
    return p ? outline_around({p->rounded, p->error, [&] { return *p; }}, part_[start(h)]).value() : kNoIndex;
  };
  std::uint32_t outside = kNoIndex;
  for (const std::uint32_t h : last) {
    if (h == kNoIndex) continue;
    const std::uint32_t around = around_part(h);
    if (around == kNoIndex && outside == kNoIndex) outside = outline_[h];
    sets.unite(outline_[h], around == kNoIndex ? outside : around);
  }
}

std::optional<std::uint32_t> PlaneGraph::face_at(const LazyPoint& p) const {
  const auto around = outline_around(p, kNoIndex);
  return around && *around != kNoIndex ? std::optional(face_[*around]) : std::nullopt;
}

// How many times an outline turns counter-clockwise around a point; nothing for a point on it. A ray along the first axis
// of the plane meets the half-edges that rise past the point and those that fall, each of which contains its lower end
// only.
std::optional<int> PlaneGraph::winding(std::uint32_t outline, const LazyPoint& p) const {
  const auto [along, up] = plane_axes(axis_);
  int winding = 0;
  bool on_outline = false;
  std::uint64_t count = 0;
  visit_outline(outline, [&, along = along, up = up](std::uint32_t h) {
    ++count;
    const LazyPoint &tail = nodes_[start(h)], &head = nodes_[end(h)];
    const int from = compare_along(tail, p, up, budget_), to = compare_along(head, p, up, budget_);
    if (from * to > 0) return;
    if (from == 0 && to == 0) {
      on_outline |= compare_along(tail, p, along, budget_) * compare_along(head, p, along, budget_) <= 0;
      return;
    }
    const int left = turn_ * side(far_end(h ^ 1), far_end(h), p);
    on_outline |= left == 0;
    const bool rises = from <= 0;
    if (rises != (to <= 0) && (left > 0) == rises) winding += rises ? turn_ : -turn_;
  });
  spend(budget_, kPassWork * count);
  return on_outline ? std::nullopt : std::optional(winding);
}

// Whether one of two outlines, both around a point, lies within the other.
bool PlaneGraph::is_within(std::uint32_t outline, std::uint32_t other) const {
  std::optional<int> turns;
  visit_outline(outline, [&](std::uint32_t h) {
    if (!turns) turns = winding(other, nodes_[start(h)]);
    if (turns) return;
    turns = winding(other, lazy_between(nodes_[start(h)], nodes_[end(h)], 1, 1));
  });
  return turns.value_or(0) > 0;  // nothing: they coincide
}

// The innermost outline that has the point on its left, of the parts of the graph other than one; kNoIndex if there is none;
// nothing for a point on a segment. Of each part one at most has it. Outlines of different parts do not cross, so one of
// two contains the other.
std::optional<std::uint32_t> PlaneGraph::outline_around(const LazyPoint& p, std::uint32_t other_than) const {
  spend(budget_, kPassWork * first_.size());
  std::uint32_t innermost = kNoIndex;
  for (std::uint32_t k = 0; k < first_.size(); ++k) {
    const std::uint32_t node = start(first_[k]);
    if (part_[node] == other_than || !satcheck::meet(boxes_[k], point_box(p))) continue;
    const auto turns = winding(k, p);
    if (!turns) return std::nullopt;
    if (*turns > 0 && (innermost == kNoIndex || is_within(k, innermost))) innermost = k;
  }
  return innermost;
}

// Counter-clockwise around the node that all of them leave.
void PlaneGraph::sort_around(std::vector<std::uint32_t>& half_edges) const {
  const std::uint32_t from = start(half_edges[0]), first = half_edges[0];
  const auto turn = [&](std::uint32_t g, std::uint32_t h) {
    if (edges_[g / 2].segment == edges_[h / 2].segment) return 0;  // float64 could not tell
    return side(from, far_end(g), nodes_[far_end(h)]);
  };
  const auto quarter = [&](std::uint32_t h) {
    const int ahead = h == first ? 0 : turn(first, h);
    return h == first ? 0 : ahead > 0 ? 1 : ahead == 0 ? 2 : 3;
  };
  std::sort(half_edges.begin(), half_edges.end(), [&](std::uint32_t g, std::uint32_t h) {
    const int quarter_g = quarter(g), quarter_h = quarter(h);
    return quarter_g != quarter_h ? quarter_g < quarter_h : g != h && turn(g, h) > 0;
  });
}

// A way leads from the middle of the half-edge to a corner on its left. Before it meets another segment, it is inside
// the cell.
std::optional<ExactPoint> PlaneGraph::inside_left_of(std::uint32_t h, const std::vector<std::uint32_t>& corners, int attempt) const {
  const Edge& edge = edges_[h / 2];
  const Segment& s = segments_[edge.segment];
  const int way = edge.forward == (h % 2 == 0) ? 1 : -1;
  const auto to = std::find_if(corners.begin(), corners.end(), [&](std::uint32_t v) { return way * side(s.from, s.to, nodes_[v]) > 0; });
  if (to == corners.end()) return std::nullopt;
  const LazyPoint middle = lazy_between(nodes_[edge.low], nodes_[edge.high], 1, 1);
  const ExactPoint &from = middle.exact(), &corner = nodes_[*to].exact();
  const Ratio clear = clear_way(middle, nodes_[*to]);
  const double parts = attempt + 2.0, fraction = rounded(clear) / parts;
  if (fraction > kSmallestFraction) return between(from, corner, Dyadic(1.0) - fraction, fraction);
  return between(from, corner, clear.denominator * parts - clear.numerator, clear.numerator);
}

// The place on the way where it first meets a segment.
Ratio PlaneGraph::clear_way(const LazyPoint& lazy_from, const LazyPoint& to) const {
  const ExactPoint &from = lazy_from.exact(), &end = to.exact();
  Ratio nearest{1.0, 1.0};
  const auto consider = [&](Ratio at) {
    if (at.numerator.sign() > 0 && less(at, nearest)) nearest = std::move(at);
  };
  const auto position = [&](const ExactPoint& v) {  // of a point on the line of the way
    const auto step = [&](const ExactPoint& p, int axis) { return coordinate(p, axis) * from.w - coordinate(from, axis) * p.w; };
    const auto [i, j] = plane_axes(axis_);
    const int k = step(end, i).sign() != 0 ? i : j;
    return make_ratio(step(v, k) * end.w, step(end, k) * v.w);
  };
  for (const Segment& o : segments_) {
    const int from_side = side(o.from, o.to, lazy_from), to_side = side(o.from, o.to, to);
    if (from_side == 0 && to_side == 0) {
      for (const std::uint32_t node : {o.from, o.to}) consider(position(nodes_[node].exact()));
    } else if (from_side * to_side < 0) {
      const auto side_of_way = [&](std::uint32_t node) { return orientation_2d_at(lazy_from, to, nodes_[node], axis_, budget_); };
      if (side_of_way(o.from) * side_of_way(o.to) > 0) continue;
      const ExactPoint &p = nodes_[o.from].exact(), &q = nodes_[o.to].exact();
      consider(zero_between(area_value(p, q, from, axis_) * end.w, area_value(p, q, end, axis_) * from.w));
    }
  }
  spend(budget_, kPairWork * segments_.size() + sign_work(from));
  return nearest;
}

}  // namespace satcheck
