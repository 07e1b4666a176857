#include "overlap/triangle_faces.hpp"

#include <algorithm>
#include <numeric>

#include "base/patches.hpp"
#include "exact/point_in_triangle.hpp"

namespace satcheck {
namespace {

// The number of segments to different points of the border that are tried. Each node and each stretch blocks at most
// one.
constexpr int kWays = 256;

// Measured steps of a way and a stretch.
constexpr std::uint64_t kStretchWork = 200;

}  // namespace

TriangleFaces::TriangleFaces(const MeetingNodes& nodes, const Corners& triangle,
                             const std::vector<std::uint32_t>& border, const std::vector<NodePair>& inner, Budget* budget)
    : nodes_(&nodes), corners_(triangle), budget_(budget), axis_(projection_axis(rounded_normal(triangle[0], triangle[1], triangle[2]))),
      turn_(orientation_2d(triangle[0], triangle[1], triangle[2], axis_)), border_count_(border.size()) {
  for (std::size_t k = 0; k < border.size(); ++k) stretches_.emplace_back(border[k], border[(k + 1) % border.size()]);
  stretches_.insert(stretches_.end(), inner.begin(), inner.end());
  trace();
}

void TriangleFaces::trace() {
  const auto half_edges = static_cast<std::uint32_t>(2 * stretches_.size());
  std::vector<std::uint32_t> leaving(half_edges), next(half_edges);
  std::iota(leaving.begin(), leaving.end(), 0u);
  std::sort(leaving.begin(), leaving.end(), [&](std::uint32_t g, std::uint32_t h) {
    return start(g) != start(h) ? start(g) < start(h) : g < h;
  });
  for (std::size_t i = 0; i < leaving.size();) {
    std::vector<std::uint32_t> around;
    for (const std::uint32_t from = start(leaving[i]); i < leaving.size() && start(leaving[i]) == from; ++i) {
      around.push_back(leaving[i]);
    }
    if (around.size() > 2) sort_around(around);
    for (std::size_t k = 0; k < around.size(); ++k) {
      next[around[k] ^ 1] = around[(k + around.size() - 1) % around.size()];
    }
  }
  std::vector<std::uint32_t> loop_of(half_edges, kOutside);
  for (std::uint32_t h = 0; h < half_edges; ++h) {
    for (std::uint32_t g = h; loop_of[g] == kOutside; g = next[g]) loop_of[g] = h;
  }
  complete_ = join_islands(loop_of);
  const std::uint32_t outside = loop_of[1];  // on the left of a stretch of the border, run backward
  std::vector<std::uint32_t> number(half_edges, kOutside);
  face_.resize(half_edges);
  for (std::uint32_t h = 0; h < half_edges; ++h) {
    std::uint32_t& face = number[loop_of[h]];
    if (loop_of[h] != outside && face == kOutside) face = count_++;
    face_[h] = face;
  }
}

// Counter-clockwise around the node that all of them leave.
void TriangleFaces::sort_around(std::vector<std::uint32_t>& half_edges) const {
  const ExactPoint& from = node(start(half_edges[0]));
  const std::uint32_t first = half_edges[0];
  const auto quarter = [&](std::uint32_t h) {
    const int turn = h == first ? 0 : side(from, node(end(first)), node(end(h)));
    return h == first ? 0 : turn > 0 ? 1 : turn == 0 ? 2 : 3;
  };
  std::sort(half_edges.begin(), half_edges.end(), [&](std::uint32_t g, std::uint32_t h) {
    const int quarter_g = quarter(g), quarter_h = quarter(h);
    return quarter_g != quarter_h ? quarter_g < quarter_h : g != h && side(from, node(end(g)), node(end(h))) > 0;
  });
}

// The stretches of each part of the graph that is not connected to the border.
std::vector<std::vector<std::uint32_t>> TriangleFaces::islands() const {
  std::vector<std::uint32_t> numbers;
  for (const auto& [i, k] : stretches_) numbers.insert(numbers.end(), {i, k});
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  const auto place = [&](std::uint32_t number) {
    return static_cast<std::uint32_t>(std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin());
  };
  DisjointSets sets(numbers.size());
  for (const auto& [i, k] : stretches_) sets.unite(place(i), place(k));
  std::map<std::uint32_t, std::vector<std::uint32_t>> members;
  for (std::uint32_t k = 0; k < stretches_.size(); ++k) members[sets.find(place(stretches_[k].first))].push_back(k);
  members.erase(sets.find(place(stretches_[0].first)));
  std::vector<std::vector<std::uint32_t>> result;
  for (auto& [_, stretches] : members) result.push_back(std::move(stretches));
  return result;
}

// After the last crossing of a segment with some islands, it is in their surrounding face, and then meets another part
// of its outline. One segment from each island therefore joins all outlines of all faces.
bool TriangleFaces::join_islands(std::vector<std::uint32_t>& loop_of) const {
  const auto parts = islands();
  if (parts.empty()) return true;
  DisjointSets loops(loop_of.size());
  for (const auto& island : parts) {
    const ExactPoint from = middle(island[0]);
    std::optional<std::vector<Crossing>> met;
    std::uint32_t behind = 0;
    for (int attempt = 0; attempt < kWays && !met; ++attempt) {
      const ExactPoint to = beyond(from, attempt);
      const int turn = side(node(stretches_[island[0]].first), node(stretches_[island[0]].second), to);
      if (turn == 0) continue;
      behind = 2 * island[0] + (turn > 0 ? 0 : 1);
      met = crossings(from, to);
    }
    if (!met) return false;
    for (const Crossing& crossing : *met) {
      loops.unite(loop_of[behind], loop_of[crossing.near_side]);
      behind = crossing.near_side ^ 1;
    }
  }
  for (std::uint32_t& loop : loop_of) loop = loops.find(loop);
  return true;
}

ExactPoint TriangleFaces::middle(std::uint32_t stretch) const {
  return between(node(stretches_[stretch].first), node(stretches_[stretch].second), 1.0, 1.0);
}

// A point outside of the triangle, opposite `from` across a point of the border.
ExactPoint TriangleFaces::beyond(const ExactPoint& from, int attempt) const {
  constexpr double kParts = 521;  // no fraction comes twice
  const double part = 1 + (attempt * 163) % 520;
  const int edge = attempt % 3;
  const ExactPoint p = make_exact_point(corners_[edge]), q = make_exact_point(corners_[(edge + 1) % 3]);
  return between(from, between(p, q, part, kParts - part), -1.0, 2.0);
}

// The stretches that the segment crosses, in order; empty if it meets a node or runs along a stretch. `from` may lie
// inside a stretch, which the segment only leaves.
std::optional<std::vector<TriangleFaces::Crossing>> TriangleFaces::crossings(const ExactPoint& from,
                                                                             const ExactPoint& to) const {
  spend(budget_, kStretchWork * stretches_.size());
  std::vector<Crossing> met;
  for (std::uint32_t k = 0; k < stretches_.size(); ++k) {
    const ExactPoint &p = node(stretches_[k].first), &q = node(stretches_[k].second);
    const int p_side = side(from, to, p), q_side = side(from, to, q);
    if (p_side * q_side > 0) continue;
    const int near = side(p, q, from), far = side(p, q, to);
    if (near == 0 && far != 0) continue;
    if (p_side * q_side == 0 || far == 0) return std::nullopt;
    if (near == far) continue;
    met.push_back({zero_between(area_value(p, q, from, axis_) * to.w, area_value(p, q, to, axis_) * from.w),
                   2 * k + (near > 0 ? 0 : 1)});
  }
  std::sort(met.begin(), met.end(), [](const Crossing& x, const Crossing& y) { return less(x.at, y.at); });
  return met;
}

std::optional<ExactPoint> TriangleFaces::sample(std::uint32_t face) const {
  for (std::uint32_t h = 0; h < face_.size(); ++h) {
    if (face_[h] != face) continue;
    const ExactPoint from = middle(h / 2);
    for (int attempt = 0; attempt < kWays; ++attempt) {
      const ExactPoint to = beyond(from, attempt);
      if (side(node(start(h)), node(end(h)), to) <= 0) continue;
      const auto met = crossings(from, to);
      if (!met || met->empty()) continue;
      const auto& [numerator, denominator] = met->front().at;
      return between(from, to, denominator * 2.0 - numerator, numerator);
    }
  }
  return std::nullopt;
}

std::optional<std::uint32_t> TriangleFaces::face_at(const ExactPoint& p) const {
  if (count_ == 1) return 0;
  for (int attempt = 0; attempt < kWays; ++attempt) {
    const auto met = crossings(p, beyond(p, attempt));
    if (met && !met->empty()) return face_[met->front().near_side];
  }
  return std::nullopt;
}

}  // namespace satcheck
