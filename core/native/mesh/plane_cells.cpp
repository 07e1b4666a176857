#include "mesh/plane_cells.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/patches.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// Measured steps of a triangle near the patch, of two segments that may meet, of a crossing and of a half-edge.
constexpr std::uint64_t kTriangleWork = 100, kPairWork = 20, kCrossingWork = 400, kHalfEdgeWork = 150;

// Below this a rounded fraction may have lost digits.
constexpr double kSmallestFraction = 1e-200;

// Points of a cell that are tried before its winding numbers count as undecided.
constexpr int kAttempts = 8;

bool holds_nothing(const Corners& c) { return collinear(c[0], c[1], c[2]); }

}  // namespace

PlaneCells::PlaneCells(std::vector<const Surface*> surfaces, PatchTriangle first, SinglePoints points, Budget* budget)
    : surfaces_(std::move(surfaces)), points_(points), budget_(budget), plane_corners_(corners_of(first)),
      plane_(plane_corners_[0], plane_corners_[1], plane_corners_[2]),
      axis_(projection_axis(rounded_normal(plane_corners_[0], plane_corners_[1], plane_corners_[2]))),
      turn_(orientation_2d(plane_corners_[0], plane_corners_[1], plane_corners_[2], axis_)), members_{first} {
  seen_[first] = true;
  gather();
  meet_segments();
  cut_segments();
  trace();
  find_windings();
}

// The triangles of the patch, and the segments in which triangles that touch them meet the plane.
void PlaneCells::gather() {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const PatchTriangle member = members_[k];
    const Corners c = corners_of(member);
    const TrianglePlane plane(c[0], c[1], c[2]);
    add_sides(member, true);
    for (int s = 0; s < static_cast<int>(surfaces_.size()); ++s) {
      const Surface& surface = *surfaces_[s];
      visit_box(surface.bvh, surface.mesh, triangle_box(surfaces_[member.surface]->mesh, member.triangle), [&](std::uint32_t t) {
        look_at({s, t}, plane);
        return true;
      }, budget_);
    }
  }
}

void PlaneCells::look_at(PatchTriangle other, const TrianglePlane& member) {
  spend(budget_, kTriangleWork);
  const auto seen = seen_.find(other);
  if (seen != seen_.end() && seen->second) return;
  const Corners c = corners_of(other);
  if (classify(member, c, budget_) == TriangleContact::disjoint || holds_nothing(c)) return;
  std::array<int, 3> side;
  for (int i = 0; i < 3; ++i) side[i] = plane_.side(c[i], budget_);
  const bool coplanar = side == std::array<int, 3>{};
  if (coplanar && coplanar_overlap({member.a, member.b, member.c}, c) != CoplanarOverlap::none) {
    members_.push_back(other);
  } else if (coplanar) {
    if (points_ == SinglePoints::all && seen == seen_.end()) add_sides(other, false);
    seen_[other] = false;  // it may share area with another member
    return;
  } else {
    add_trace(other.surface, c, side);
  }
  seen_[other] = true;
}

void PlaneCells::add_sides(PatchTriangle coplanar, bool is_member) {
  const Corners c = corners_of(coplanar);
  // A triangle that faces backward has its inside on the right.
  const int inward = turn_ * orientation_2d(c[0], c[1], c[2], axis_);
  for (int i = 0; i < 3; ++i) {
    add_segment(vertex(c[i]), vertex(c[(i + 1) % 3]), coplanar.surface, {is_member ? -inward : 0, 0, 0});
  }
}

// side: of each corner. The part of the triangle in front of the plane runs along its trace from `from` to `to`.
void PlaneCells::add_trace(int surface, const Corners& c, const std::array<int, 3>& side) {
  std::uint32_t from = kNone, to = kNone;
  Change change;
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3, before = side[(i + 2) % 3];
    if (side[i] == 0 && side[k] == 0) {  // an edge; a triangle behind the plane runs along it the other way
      from = vertex(c[i]), to = vertex(c[k]);
      (before > 0 ? change.front : change.back) = before > 0 ? -1 : 1;
      return add_segment(from, to, surface, change);
    }
    if (side[i] > 0 && side[k] < 0) from = piercing(c[i], c[k]);
    if (side[i] < 0 && side[k] > 0) to = piercing(c[i], c[k]);
    if (side[i] == 0 && before * side[k] < 0) (before > 0 ? from : to) = vertex(c[i]);
    if (side[i] == 0 && before * side[k] > 0 && points_ == SinglePoints::all) {
      const Vec3 corner = plane_corners_[c[i] == plane_corners_[0] ? 1 : 0];
      return add_segment(vertex(corner), vertex(c[i]), surface, {});
    }
  }
  if (from != kNone && to != kNone) add_segment(from, to, surface, {0, -1, -1});
}

std::uint32_t PlaneCells::vertex(Vec3 p) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  const auto [known, is_new] = vertices_.try_emplace({p.x, p.y, p.z}, number);
  if (is_new) nodes_.emplace_back(p, Vec3{}, [this, number] { return make_exact_point(nodes_[number].rounded); });
  return known->second;
}

std::uint32_t PlaneCells::piercing(Vec3 p, Vec3 q) {
  if (coordinates_less(q, p)) std::swap(p, q);
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  const auto known = piercings_.try_emplace({p.x, p.y, p.z, q.x, q.y, q.z}, number).first;
  if (known->second == number) {
    const std::array<double, 6>& key = known->first;
    nodes_.push_back(lazy_meeting_point(plane_corners_, p, q, [this, &key] {
      return plane_meeting_point(plane_corners_[0], plane_corners_[1], plane_corners_[2], {key[0], key[1], key[2]},
                                 {key[3], key[4], key[5]});
    }));
  }
  return known->second;
}

void PlaneCells::add_segment(std::uint32_t from, std::uint32_t to, int surface, Change change) {
  if (from == to) return;
  const int way = from < to ? 1 : -1;
  const auto [known, is_new] = segment_of_.try_emplace(std::minmax(from, to), static_cast<std::uint32_t>(segments_.size()));
  if (is_new) segments_.push_back({std::min(from, to), std::max(from, to), {}, {}, {}});
  Change& sum = segments_[known->second].changes[surface];
  sum.cover += way * change.cover;
  sum.front += way * change.front;
  sum.back += way * change.back;
}

// Sweeps along the widest axis, where the fewest segments are near each other.
void PlaneCells::meet_segments() {
  std::vector<Aabb> boxes;
  Aabb all;
  for (const Segment& s : segments_) {
    Aabb& box = boxes.emplace_back(point_box(nodes_[s.from]));
    box.include(point_box(nodes_[s.to]));
    all.include(box);
  }
  const Vec3 size = all.max - all.min;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
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

void PlaneCells::meet(std::uint32_t i, std::uint32_t k) {
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
  const auto end = [](const Segment& of, int from, int to) { return from == 0 ? of.from : to == 0 ? of.to : kNone; };
  std::uint32_t of_s = end(s, s_from, s_to), of_o = end(o, o_from, o_to);
  if (of_s != kNone && of_o != kNone) {
    if (of_s != of_o) same_.emplace_back(of_s, of_o);
  } else if (of_s != kNone) {
    segments_[k].stops.push_back(of_s);
  } else if (of_o != kNone) {
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
void PlaneCells::stop_at(std::uint32_t segment, std::uint32_t node) {
  Segment& s = segments_[segment];
  if (node == s.from || node == s.to) return;
  const int axis = axis_along(s), way = compare_along(nodes_[s.to], nodes_[s.from], axis);
  const int beyond = way * compare_along(nodes_[node], nodes_[s.from], axis);
  const int before = way * compare_along(nodes_[s.to], nodes_[node], axis);
  if (beyond == 0 || before == 0) same_.emplace_back(node, beyond == 0 ? s.from : s.to);
  if (beyond > 0 && before > 0) s.stops.push_back(node);
}

int PlaneCells::axis_along(const Segment& s) const {
  const Vec3 way = nodes_[s.to].rounded - nodes_[s.from].rounded;
  const int widest = projection_axis(way);
  if (compare_along(nodes_[s.to], nodes_[s.from], widest) != 0) return widest;
  return compare_along(nodes_[s.to], nodes_[s.from], (widest + 1) % 3) != 0 ? (widest + 1) % 3 : (widest + 2) % 3;
}

void PlaneCells::cut_segments() {
  for (Segment& s : segments_) {
    const int axis = axis_along(s), way = compare_along(nodes_[s.to], nodes_[s.from], axis);
    std::sort(s.stops.begin(), s.stops.end());
    s.stops.erase(std::unique(s.stops.begin(), s.stops.end()), s.stops.end());
    std::sort(s.stops.begin(), s.stops.end(), [&](std::uint32_t p, std::uint32_t q) {
      const int order = p == q ? 0 : way * compare_along(nodes_[p], nodes_[q], axis);
      return order != 0 ? order < 0 : p < q;
    });
    for (std::size_t k = 1; k < s.stops.size(); ++k) {
      if (compare_along(nodes_[s.stops[k - 1]], nodes_[s.stops[k]], axis) == 0) same_.emplace_back(s.stops[k - 1], s.stops[k]);
    }
  }
  DisjointSets names(nodes_.size()), parts(nodes_.size());
  for (const auto& [p, q] : same_) names.unite(p, q);
  for (std::uint32_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    std::uint32_t from = names.find(s.from);
    const auto go_to = [&](std::uint32_t node) {
      const std::uint32_t to = names.find(node);
      if (from == to) return;
      parts.unite(from, to);
      Edge edge{std::min(from, to), std::max(from, to), i, from < to, s.changes};
      for (Change& c : edge.changes) {
        if (from > to) c = {-c.cover, -c.front, -c.back};
      }
      edges_.push_back(edge);
      from = to;
    };
    for (const std::uint32_t node : s.stops) go_to(node);
    go_to(s.to);
  }
  std::sort(edges_.begin(), edges_.end(), [](const Edge& e, const Edge& f) {
    return std::tie(e.low, e.high, e.segment) < std::tie(f.low, f.high, f.segment);
  });
  std::size_t count = 0;
  for (const Edge& edge : edges_) {
    const bool goes_on = count > 0 && edges_[count - 1].low == edge.low && edges_[count - 1].high == edge.high;
    if (goes_on) {
      for (int k = 0; k < 2; ++k) {
        Change& sum = edges_[count - 1].changes[k];
        const Change& c = edge.changes[k];
        sum = {sum.cover + c.cover, sum.front + c.front, sum.back + c.back};
      }
    }
    segments_[edge.segment].edges.push_back(static_cast<std::uint32_t>(goes_on ? count - 1 : count));
    if (!goes_on) edges_[count++] = edge;
  }
  edges_.erase(edges_.begin() + static_cast<std::ptrdiff_t>(count), edges_.end());
  part_.resize(nodes_.size());
  for (std::uint32_t k = 0; k < part_.size(); ++k) part_[k] = parts.find(k);
}

// The end of the segment ahead of a half-edge: it has fewer digits than the next node.
std::uint32_t PlaneCells::far_end(std::uint32_t h) const {
  const Edge& edge = edges_[h / 2];
  const Segment& s = segments_[edge.segment];
  return edge.forward == (h % 2 == 0) ? s.to : s.from;
}

PlaneCells::Changes PlaneCells::changes(std::uint32_t h) const {
  Changes changes = edges_[h / 2].changes;
  for (Change& c : changes) {
    if (h % 2 != 0) c = {-c.cover, -c.front, -c.back};
  }
  return changes;
}

void PlaneCells::trace() {
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
  outline_.assign(half_edges, kNone);
  for (std::uint32_t h = 0; h < half_edges; ++h) {
    if (outline_[h] != kNone) continue;
    for (std::uint32_t g = h; outline_[g] == kNone; g = next_[g]) outline_[g] = static_cast<std::uint32_t>(first_.size());
    first_.push_back(h);
  }
}

// Counter-clockwise around the node that all of them leave.
void PlaneCells::sort_around(std::vector<std::uint32_t>& half_edges) const {
  const std::uint32_t from = start(half_edges[0]), first = half_edges[0];
  const auto turn = [&](std::uint32_t g, std::uint32_t h) { return side(from, far_end(g), nodes_[far_end(h)]); };
  const auto quarter = [&](std::uint32_t h) {
    const int ahead = h == first ? 0 : turn(first, h);
    return h == first ? 0 : ahead > 0 ? 1 : ahead == 0 ? 2 : 3;
  };
  std::sort(half_edges.begin(), half_edges.end(), [&](std::uint32_t g, std::uint32_t h) {
    const int quarter_g = quarter(g), quarter_h = quarter(h);
    return quarter_g != quarter_h ? quarter_g < quarter_h : g != h && turn(g, h) > 0;
  });
}

// A half-edge at which the patch ends on the right starts on each part of the graph that has one. The other parts lie
// in one cell of the patch, or outside.
void PlaneCells::find_windings() {
  sides_.resize(first_.size());
  std::vector<bool> started(nodes_.size(), false);  // by part
  const auto half_edges = static_cast<std::uint32_t>(next_.size());
  for (std::uint32_t h = 0; h < half_edges; ++h) {
    const Changes c = changes(h);
    if (c[0].cover >= 0 && c[1].cover >= 0) continue;
    started[part_[start(h)]] = true;
    if (!sides_[outline_[h]].known) start_at(h);
  }
  for (std::uint32_t h = 0; h < half_edges; ++h) {
    if (started[part_[start(h)]]) continue;
    started[part_[start(h)]] = true;
    start_at(h);
  }
  for (std::uint32_t k = 0; k < sides_.size(); ++k) {
    if (sides_[k].in_patch()) in_patch_.push_back(k);
  }
}

void PlaneCells::start_at(std::uint32_t h) {
  Sides& sides = sides_[outline_[h]];
  sides.known = true;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const auto p = inside_left_of(h, attempt);
    if (!p) return;  // no triangle of the patch is there
    sides.at = {};
    for (const PatchTriangle& member : members_) sides.at[member.surface].cover += holds(corners_of(member), *p) ? 1 : 0;
    if (!sides.in_patch()) return;
    sides.decided = true;
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      const auto& [a, b, c] = plane_corners_;
      const auto beside = winding_beside(surfaces_[s]->mesh, surfaces_[s]->bvh, *p, a, b, c, {}, budget_);
      sides.decided = sides.decided && beside;
      if (beside) sides.at[s].front = beside->front, sides.at[s].back = beside->back;
    }
    if (sides.decided) break;
  }
  spread(outline_[h]);
}

void PlaneCells::spread(std::uint32_t outline) {
  std::vector<std::uint32_t> stack{outline};
  while (!stack.empty()) {
    const std::uint32_t here = stack.back();
    stack.pop_back();
    std::uint32_t h = first_[here];
    do {
      Sides beyond = sides_[here];
      const Changes change = changes(h);
      for (int s = 0; s < 2; ++s) {
        beyond.at[s].cover += change[s].cover;
        beyond.at[s].front += change[s].front;
        beyond.at[s].back += change[s].back;
      }
      const std::uint32_t there = outline_[h ^ 1];
      if (!sides_[there].known) {
        sides_[there] = beyond;
        if (beyond.in_patch()) stack.push_back(there);
      } else if (beyond.in_patch() && beyond.at != sides_[there].at) {
        consistent_ = false;
      }
      h = next_[h];
    } while (h != first_[here]);
  }
}

std::optional<Beside> PlaneCells::beside(std::uint32_t outline, int surface) const {
  const Sides& sides = sides_[outline];
  if (!consistent_ || !sides.decided) return std::nullopt;
  const Change& at = sides.at[surface];
  return Beside{at.front, at.back, at.cover > 0};
}

ExactPoint PlaneCells::inside(std::uint32_t outline) const { return *inside_left_of(first_[outline], 0); }

// A way leads from the middle of the half-edge to a corner of the patch on its left. Before it meets another segment, it
// is inside the cell.
std::optional<ExactPoint> PlaneCells::inside_left_of(std::uint32_t h, int attempt) const {
  const Edge& edge = edges_[h / 2];
  const Segment& s = segments_[edge.segment];
  const int way = edge.forward == (h % 2 == 0) ? 1 : -1;
  for (const PatchTriangle& member : members_) {
    for (const Vec3& corner : corners_of(member)) {
      const std::uint32_t to = vertices_.at({corner.x, corner.y, corner.z});
      if (way * side(s.from, s.to, nodes_[to]) <= 0) continue;
      const LazyPoint &low = nodes_[edge.low], &high = nodes_[edge.high], lazy = lazy_between(low, high, 1, 1);
      const ExactPoint& from = lazy.exact();
      const Ratio clear = clear_way(from, lazy, to);
      const double parts = attempt + 2.0, fraction = rounded(clear) / parts;
      if (fraction > kSmallestFraction) return between(from, nodes_[to].exact(), Dyadic(1.0) - fraction, fraction);
      return between(from, nodes_[to].exact(), clear.denominator * parts - clear.numerator, clear.numerator);
    }
  }
  return std::nullopt;
}

// The place on the way where it first meets a segment.
Ratio PlaneCells::clear_way(const ExactPoint& from, const LazyPoint& lazy_from, std::uint32_t to) const {
  const ExactPoint& end = nodes_[to].exact();
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
    const int from_side = side(o.from, o.to, lazy_from), to_side = side(o.from, o.to, nodes_[to]);
    if (from_side == 0 && to_side == 0) {
      for (const std::uint32_t node : {o.from, o.to}) consider(position(nodes_[node].exact()));
    } else if (from_side * to_side < 0) {
      const auto side_of_way = [&](std::uint32_t node) { return orientation_2d_at(lazy_from, nodes_[to], nodes_[node], axis_); };
      if (side_of_way(o.from) * side_of_way(o.to) > 0) continue;
      const ExactPoint &p = nodes_[o.from].exact(), &q = nodes_[o.to].exact();
      consider(zero_between(area_value(p, q, from, axis_) * end.w, area_value(p, q, end, axis_) * from.w));
    }
  }
  spend(budget_, kPairWork * segments_.size() + sign_work(from));
  return nearest;
}

// p is on no side of the triangle.
bool PlaneCells::holds(const Corners& triangle, const ExactPoint& p) const {
  const int first = orientation_2d_at(triangle[0], triangle[1], p, axis_);
  return first == orientation_2d_at(triangle[1], triangle[2], p, axis_) && first == orientation_2d_at(triangle[2], triangle[0], p, axis_);
}

std::array<std::uint32_t, 2> PlaneCells::triangles_at(const ExactPoint& p) const {
  std::array<std::uint32_t, 2> at{kNone, kNone};
  for (const PatchTriangle& member : members_) {
    if (at[member.surface] == kNone && holds(corners_of(member), p)) at[member.surface] = member.triangle;
  }
  return at;
}

// Parts of the graph that do not meet the sides of the triangle are completely inside it, or not at all.
std::vector<std::uint32_t> PlaneCells::outlines_in(PatchTriangle member) const {
  const Corners c = corners_of(member);
  const bool forward = turn_ * orientation_2d(c[0], c[1], c[2], axis_) > 0;
  std::vector<bool> is_side(edges_.size(), false), visited(first_.size(), false);
  std::vector<std::uint32_t> stack;
  const auto push = [&](std::uint32_t outline) {
    if (!visited[outline]) stack.push_back(outline);
    visited[outline] = true;
  };
  std::array<std::uint32_t, 3> at;
  for (int i = 0; i < 3; ++i) at[i] = vertices_.at({c[i].x, c[i].y, c[i].z});
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t from = at[forward ? i : (i + 1) % 3], to = at[forward ? (i + 1) % 3 : i];
    const std::uint32_t number = segment_of_.at(std::minmax(from, to));
    const Segment& s = segments_[number];
    const int axis = axis_along(s);
    for (const std::uint32_t e : s.edges) {
      is_side[e] = true;
      const bool upward = compare_along(nodes_[edges_[e].high], nodes_[edges_[e].low], axis) == compare_along(nodes_[to], nodes_[from], axis);
      push(outline_[2 * e + (upward ? 0 : 1)]);
    }
  }
  std::vector<std::uint32_t> inside;
  while (!stack.empty()) {
    const std::uint32_t here = stack.back();
    stack.pop_back();
    inside.push_back(here);
    std::uint32_t h = first_[here];
    do {
      if (!is_side[h / 2]) push(outline_[h ^ 1]);
      h = next_[h];
    } while (h != first_[here]);
  }
  for (const std::uint32_t k : in_patch_) {
    const std::uint32_t node = start(first_[k]);
    if (visited[k] || part_[node] == part_[start(first_[inside[0]])]) continue;
    const auto on_left = [&](int i) { return side(at[i], at[(i + 1) % 3], nodes_[node]) * (forward ? 1 : -1) > 0; };
    if (on_left(0) && on_left(1) && on_left(2)) inside.push_back(k);
  }
  return inside;
}

std::vector<std::uint32_t> PlaneCells::nodes_of(std::uint32_t outline) const {
  std::vector<std::uint32_t> nodes;
  std::uint32_t h = first_[outline];
  do {
    nodes.push_back(start(h));
    h = next_[h];
  } while (h != first_[outline]);
  return nodes;
}

std::vector<std::uint32_t> PlaneCells::outlines_at(const LazyPoint& x) const {
  std::vector<std::uint32_t> outlines;
  for (std::uint32_t h = 0; h < next_.size(); ++h) {
    const LazyPoint& node = nodes_[start(h)];
    if (!satcheck::meet(point_box(node), point_box(x)) || !sides_[outline_[h]].in_patch()) continue;
    if (compare_along(node, x, 0) == 0 && compare_along(node, x, 1) == 0 && compare_along(node, x, 2) == 0) {
      outlines.push_back(outline_[h]);
    }
  }
  return outlines;
}

}  // namespace satcheck
