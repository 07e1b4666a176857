#include "overlap/triangle_faces.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// The number of segments to different points of the border that are tried. Each node and each stretch blocks at most
// one.
constexpr int kWays = 256;

// Measured steps of a way and a stretch.
constexpr std::uint64_t kStretchWork = 200;

LazyPoint lazy(const ExactPoint& p) {
  return {p.rounded, p.error, [&p] { return p; }};
}

}  // namespace

TriangleFaces::TriangleFaces(const MeetingNodes& nodes, const Corners& triangle, const std::array<TriangleSide, 3>& sides,
                             const std::vector<NodePair>& segments, Budget* budget)
    : corners_(triangle), budget_(budget), graph_(triangle, budget) {
  make_graph(nodes, sides, segments);
  DisjointSets outlines(graph_.outline_count());
  complete_ = join_islands(outlines);
  const std::uint32_t outside = outlines.find(graph_.outline(in_graph(1)));
  std::vector<std::uint32_t> number(graph_.outline_count(), kOutside);
  for (std::size_t h = 0; h < half_edge_count(); ++h) {
    const std::uint32_t set = outlines.find(graph_.outline(in_graph(h)));
    if (set != outside && number[set] == kOutside) number[set] = count_++;
  }
  face_.resize(graph_.outline_count());
  for (std::uint32_t k = 0; k < face_.size(); ++k) face_[k] = number[outlines.find(k)];
}

void TriangleFaces::make_graph(const MeetingNodes& nodes, const std::array<TriangleSide, 3>& sides,
                               const std::vector<NodePair>& segments) {
  std::map<std::uint32_t, std::uint32_t> numbers;
  std::vector<int> on_sides;  // of each node of the graph: bit i for side i
  const auto node = [&](std::uint32_t name, int bits) {
    const auto [known, is_new] = numbers.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (is_new) {
      names_.push_back(name);
      on_sides.push_back(0);
      graph_.add_node(lazy(nodes.at(name)));
    }
    on_sides[known->second] |= bits;
    return known->second;
  };
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t from = node(sides[i].from, 1 << i), to = node(sides[i].to, 1 << i);
    graph_.add_segment(from, to, 0, {});
    for (const std::uint32_t name : sides[i].inside) graph_.add_stop(from, to, node(name, 1 << i));
  }
  std::vector<NodePair> inner;
  for (const auto& [low, high] : segments) {
    const std::uint32_t from = node(low, 0), to = node(high, 0);
    if (from == to || (on_sides[from] & on_sides[to]) != 0) continue;
    graph_.add_segment(from, to, 0, {});
    inner.emplace_back(from, to);
  }
  graph_.build_named();
  for (int i = 0; i < 3; ++i) {
    const std::vector<std::uint32_t> along = graph_.along(node(sides[i].from, 0), node(sides[i].to, 0));
    forward_.insert(forward_.end(), along.begin(), along.end());
    side_.resize(forward_.size(), i);
  }
  for (const auto& [from, to] : inner) forward_.push_back(graph_.along(from, to).front());
}

// After the last crossing of a segment with some islands, it is in their surrounding face, and then meets another part
// of its outline. One segment from each part of the graph that is not connected to the border therefore joins all
// outlines of all faces.
bool TriangleFaces::join_islands(DisjointSets& outlines) const {
  std::set<std::uint32_t> done{graph_.part(graph_.start(forward_[0]))};
  for (const std::uint32_t h : forward_) {
    if (!done.insert(graph_.part(graph_.start(h))).second) continue;
    const ExactPoint from = middle(h);
    std::optional<std::vector<Crossing>> met;
    std::uint32_t behind = h;
    for (int attempt = 0; attempt < kWays && !met; ++attempt) {
      const ExactPoint to = beyond(from, attempt);
      const int turn = graph_.side(graph_.start(h), graph_.end(h), lazy(to));
      if (turn == 0) continue;
      behind = turn > 0 ? h : h ^ 1;
      met = crossings(from, to);
    }
    if (!met) return false;
    for (const Crossing& crossing : *met) {
      outlines.unite(graph_.outline(behind), graph_.outline(crossing.near_side));
      behind = crossing.near_side ^ 1;
    }
  }
  return true;
}

ExactPoint TriangleFaces::middle(std::uint32_t half_edge) const {
  return between(graph_.node(graph_.start(half_edge)).exact(), graph_.node(graph_.end(half_edge)).exact(), 1.0, 1.0);
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
  spend(budget_, kStretchWork * forward_.size());
  const LazyPoint start = lazy(from), end = lazy(to);
  const auto side = [&](const LazyPoint& p, const LazyPoint& q, const LazyPoint& of) {
    return graph_.turn() * orientation_2d_at(p, q, of, graph_.axis());
  };
  std::vector<Crossing> met;
  for (const std::uint32_t h : forward_) {
    const LazyPoint &p = graph_.node(graph_.start(h)), &q = graph_.node(graph_.end(h));
    const int p_side = side(start, end, p), q_side = side(start, end, q);
    if (p_side * q_side > 0) continue;
    const int near = side(p, q, start), far = side(p, q, end);
    if (near == 0 && far != 0) continue;
    if (p_side * q_side == 0 || far == 0) return std::nullopt;
    if (near == far) continue;
    const auto area = [&](const ExactPoint& of) { return area_value(p.exact(), q.exact(), of, graph_.axis()); };
    met.push_back({zero_between(area(from) * to.w, area(to) * from.w), near > 0 ? h : h ^ 1});
  }
  std::sort(met.begin(), met.end(), [](const Crossing& x, const Crossing& y) { return less(x.at, y.at); });
  return met;
}

std::optional<ExactPoint> TriangleFaces::sample(std::uint32_t face) const {
  for (std::size_t h = 0; h < half_edge_count(); ++h) {
    if (left(h) != face) continue;
    const std::uint32_t g = in_graph(h);
    const ExactPoint from = middle(g);
    for (int attempt = 0; attempt < kWays; ++attempt) {
      const ExactPoint to = beyond(from, attempt);
      if (graph_.side(graph_.start(g), graph_.end(g), lazy(to)) <= 0) continue;
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
    if (met && !met->empty()) return face_[graph_.outline(met->front().near_side)];
  }
  return std::nullopt;
}

}  // namespace satcheck
