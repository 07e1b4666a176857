#include "overlap/triangle_faces.hpp"

#include <map>

namespace satcheck {
namespace {

LazyPoint lazy(const ExactPoint& p) {
  return {p.rounded, p.error, [&p] { return p; }};
}

}  // namespace

TriangleFaces::TriangleFaces(const MeetingNodes& nodes, int mesh, const Triangle& triangle, const Corners& corners,
                             const std::vector<NodePair>& segments, Budget* budget)
    : graph_(corners, budget) {
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
    const std::uint32_t first = triangle[i], last = triangle[(i + 1) % 3];
    const std::uint32_t from = node(nodes.of_vertex(mesh, first), 1 << i), to = node(nodes.of_vertex(mesh, last), 1 << i);
    corners_.push_back(from);
    graph_.add_segment(from, to, 0, {});
    for (const std::uint32_t name : nodes.inside(mesh, MeshFeature::edge(first, last))) {
      graph_.add_stop(from, to, node(name, 1 << i));
    }
  }
  for (const auto& [low, high] : segments) {
    const std::uint32_t from = node(low, 0), to = node(high, 0);
    if ((on_sides[from] & on_sides[to]) == 0) graph_.add_segment(from, to, 0, {});
  }
  graph_.build_named();
  std::uint32_t along = 0;  // the first side
  while (graph_.segment(along) != 0 || graph_.start(along) != corners_[0]) ++along;
  outside_ = graph_.face(along ^ 1);
}

ExactPoint TriangleFaces::sample(std::uint32_t face) const {
  return *graph_.inside_left_of(graph_.first(face < outside_ ? face : face + 1), corners_, 0);
}

std::uint32_t TriangleFaces::face_at(const ExactPoint& p) const {
  return count() == 1 ? 0 : name_of(graph_.face_at(lazy(p)));
}

}  // namespace satcheck
