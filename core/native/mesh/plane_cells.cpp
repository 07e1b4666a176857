#include "mesh/plane_cells.hpp"

#include <algorithm>

#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// Measured steps of a triangle near the patch, of a triangle that may hold a point, and of a part of the plane in a list.
constexpr std::uint64_t kNearWork = 100, kHoldsWork = 30, kPartWork = 5;

// Points of a cell that are tried before its winding numbers count as undecided.
constexpr int kAttempts = 8;

}  // namespace

PlaneCells::PlaneCells(std::vector<const Surface*> surfaces, PatchTriangle first, SinglePoints points, Budget* budget)
    : surfaces_(std::move(surfaces)), points_(points), budget_(budget), first_corners_(corners_of(first)),
      plane_(first_corners_[0], first_corners_[1], first_corners_[2]), graph_(first_corners_, budget), members_{first} {
  seen_[key(first)] = Seen::done;
  gather();
  graph_.build();
  find_windings();
}

// The triangles of the patch, and the segments in which triangles near them meet the plane.
void PlaneCells::gather() {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const PatchTriangle member = members_[k];
    const Corners c = corners_of(member);
    add_sides(member, true);
    for (int s = 0; s < static_cast<int>(surfaces_.size()); ++s) {
      const Surface& surface = *surfaces_[s];
      visit_box(surface.bvh, surface.mesh, triangle_box(surfaces_[member.surface]->mesh, member.triangle), [&](std::uint32_t t) {
        look_at({s, t}, c);
        return true;
      }, budget_);
    }
  }
}

void PlaneCells::look_at(PatchTriangle other, const Corners& member) {
  spend(budget_, kNearWork);
  auto seen = seen_.find(key(other));
  if (seen != seen_.end() && seen->second == Seen::done) return;
  const Corners c = corners_of(other);
  if (seen == seen_.end()) {
    std::array<int, 3> side;
    for (int i = 0; i < 3; ++i) {
      const bool is_corner = std::find(first_corners_.begin(), first_corners_.end(), c[i]) != first_corners_.end();
      side[i] = is_corner ? 0 : plane_.side(c[i], budget_);
    }
    const auto [low, high] = std::minmax_element(side.begin(), side.end());
    const bool straddles = *low < 0 && *high > 0, is_flat = *low == 0 && *high == 0;
    if (straddles && classify(member, c, budget_) == TriangleContact::disjoint) return;  // it may meet another member
    seen = seen_.emplace(key(other), is_flat ? Seen::coplanar : Seen::done).first;
    if (*low > 0 || *high < 0) return;
    if (is_collinear(c, budget_)) {
      seen->second = Seen::done;
    } else if (!is_flat) {
      add_trace(other.surface, c, side);
    } else if (points_ == SinglePoints::all) {
      add_sides(other, false);
    }
  }
  if (seen->second == Seen::coplanar && share_area(member, c, graph_.axis(), budget_)) {
    seen->second = Seen::done;
    members_.push_back(other);
  }
}

void PlaneCells::add_sides(PatchTriangle coplanar, bool is_member) {
  const Corners c = corners_of(coplanar);
  // A triangle that faces backward has its inside on the right.
  const int inward = graph_.turn() * orientation_2d(c[0], c[1], c[2], graph_.axis(), budget_);
  std::array<std::uint32_t, 3> at;
  for (int i = 0; i < 3; ++i) at[i] = graph_.vertex(c[i]);
  for (int i = 0; i < 3; ++i) graph_.add_segment(at[i], at[(i + 1) % 3], coplanar.surface, {is_member ? -inward : 0, 0, 0});
  if (is_member) corners_.insert(corners_.end(), at.begin(), at.end());
}

// side: of each corner. The part of the triangle in front of the plane runs along its trace from `from` to `to`.
void PlaneCells::add_trace(int surface, const Corners& c, const std::array<int, 3>& side) {
  std::uint32_t from = kNoIndex, to = kNoIndex;
  PlaneChange change;
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3, before = side[(i + 2) % 3];
    if (side[i] == 0 && side[k] == 0) {  // an edge; a triangle behind the plane runs along it the other way
      from = graph_.vertex(c[i]), to = graph_.vertex(c[k]);
      (before > 0 ? change.front : change.back) = before > 0 ? -1 : 1;
      return graph_.add_segment(from, to, surface, change);
    }
    if (side[i] > 0 && side[k] < 0) from = graph_.piercing(c[i], c[k]);
    if (side[i] < 0 && side[k] > 0) to = graph_.piercing(c[i], c[k]);
    if (side[i] == 0 && before * side[k] < 0) (before > 0 ? from : to) = graph_.vertex(c[i]);
    if (side[i] == 0 && before * side[k] > 0 && points_ == SinglePoints::all) {
      const Vec3 corner = first_corners_[c[i] == first_corners_[0] ? 1 : 0];
      return graph_.add_segment(graph_.vertex(corner), graph_.vertex(c[i]), surface, {});
    }
  }
  if (from != kNoIndex && to != kNoIndex) graph_.add_segment(from, to, surface, {0, -1, -1});
}

// The triangles of the patch share area, so its cells are neighbours of neighbours of any one.
void PlaneCells::find_windings() {
  sides_.resize(graph_.face_count());
  const auto patch_ends = [&](std::uint32_t h) {  // on the right
    const PlaneChanges changes = graph_.changes(h);
    return changes[0].cover < 0 || changes[1].cover < 0;
  };
  std::uint32_t h = 0;
  while (!patch_ends(h)) ++h;
  start_left_of(h);
  spread(graph_.face(h));
  for (; h < graph_.half_edge_count(); ++h) decided_ = decided_ && (!patch_ends(h) || sides_[graph_.face(h)].in_patch());
  for (std::uint32_t k = 0; k < sides_.size(); ++k) {
    if (sides_[k].in_patch()) in_patch_.push_back(k);
  }
}

void PlaneCells::start_left_of(std::uint32_t h) {
  Sides& sides = sides_[graph_.face(h)];
  sides.known = true;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const ExactPoint p = *graph_.inside_left_of(h, corners_, attempt);
    sides.at = {};
    for (const PatchTriangle& member : members_at(p)) ++sides.at[member.surface].cover;
    decided_ = true;
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      const auto& [a, b, c] = first_corners_;
      const auto beside = winding_beside(surfaces_[s]->mesh, surfaces_[s]->bvh, p, a, b, c, {}, budget_);
      decided_ = decided_ && beside;
      if (beside) sides.at[s].front = beside->front, sides.at[s].back = beside->back;
    }
    if (decided_) return;
  }
}

void PlaneCells::spread(std::uint32_t cell) {
  std::vector<std::uint32_t> stack{cell};
  while (!stack.empty()) {
    const std::uint32_t here = stack.back();
    stack.pop_back();
    graph_.visit(here, [&](std::uint32_t h) {
      Sides beyond = sides_[here];
      const PlaneChanges changes = graph_.changes(h);
      for (int s = 0; s < 2; ++s) beyond.at[s] += changes[s];
      Sides& there = sides_[graph_.face(h ^ 1)];
      if (!there.known) {
        there = beyond;
        if (beyond.in_patch()) stack.push_back(graph_.face(h ^ 1));
      } else if (beyond.in_patch() && beyond.at != there.at) {
        decided_ = false;
      }
    });
  }
}

std::optional<Beside> PlaneCells::beside(std::uint32_t cell, int surface) const {
  if (!decided_) return std::nullopt;
  const PlaneChange& at = sides_[cell].at[surface];
  return Beside{at.front, at.back, at.cover > 0};
}

ExactPoint PlaneCells::inside(std::uint32_t cell) const {
  return *graph_.inside_left_of(graph_.first(cell), corners_, 0);
}

// p is on no side of the triangle.
bool PlaneCells::holds(const Corners& triangle, const ExactPoint& p) const {
  const auto side = [&](int i) { return orientation_2d_at(triangle[i], triangle[(i + 1) % 3], p, graph_.axis(), budget_); };
  return side(0) == side(1) && side(0) == side(2);
}

std::vector<PatchTriangle> PlaneCells::members_at(const ExactPoint& p) const {
  spend(budget_, kHoldsWork * members_.size());
  std::vector<PatchTriangle> at;
  std::copy_if(members_.begin(), members_.end(), std::back_inserter(at),
               [&](const PatchTriangle& member) { return holds(corners_of(member), p); });
  return at;
}

std::vector<std::uint32_t> PlaneCells::nodes_of(std::uint32_t cell) const {
  std::vector<std::uint32_t> nodes;
  graph_.visit(cell, [&](std::uint32_t h) { nodes.push_back(graph_.start(h)); });
  return nodes;
}

std::vector<std::uint32_t> PlaneCells::cells_at(const LazyPoint& x) const {
  spend(budget_, kPartWork * graph_.half_edge_count());
  std::vector<std::uint32_t> cells;
  for (std::uint32_t h = 0; h < graph_.half_edge_count(); ++h) {
    const LazyPoint& node = graph_.node(graph_.start(h));
    if (!meet(point_box(node), point_box(x)) || !sides_[graph_.face(h)].in_patch()) continue;
    const auto same = [&](int axis) { return compare_along(node, x, axis, budget_) == 0; };
    if (same(0) && same(1) && same(2)) cells.push_back(graph_.face(h));
  }
  return cells;
}

}  // namespace satcheck
