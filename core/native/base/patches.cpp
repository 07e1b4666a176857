#include "base/patches.hpp"

#include <numeric>

#include "base/large_pages.hpp"

namespace satcheck {
namespace {

Labels number_sets(DisjointSets& sets, std::size_t triangle_count) {
  Labels labels;
  labels.of_triangle.resize(triangle_count);
  for (std::uint32_t t = 0; t < triangle_count; ++t) {
    // The representative is the smallest member, so its number is already known.
    const std::uint32_t first = sets.find(t);
    labels.of_triangle[t] =
        first == t ? static_cast<std::uint32_t>(labels.count++) : labels.of_triangle[first];
  }
  return labels;
}

}  // namespace

DisjointSets::DisjointSets(std::size_t n) : parent_(with_room<std::uint32_t>(n)) {
  parent_.resize(n);
  std::iota(parent_.begin(), parent_.end(), 0u);
}

std::vector<std::vector<std::uint32_t>> Labels::members() const {
  std::vector<std::vector<std::uint32_t>> result(count);
  for (std::uint32_t t = 0; t < of_triangle.size(); ++t) result[of_triangle[t]].push_back(t);
  return result;
}

Labels label_components(const Mesh& welded, const EdgeTable& edges) {
  DisjointSets sets(welded.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto half_edges = edges.half_edges(e);
    for (const std::uint32_t h : half_edges.subspan(1)) sets.unite(half_edges[0] / 3, h / 3);
  }
  return number_sets(sets, welded.triangles.size());
}

Labels label_vertex_components(const Mesh& welded) {
  constexpr std::uint32_t none = 0xFFFFFFFF;
  DisjointSets sets(welded.triangles.size());
  std::vector<std::uint32_t> first_at(welded.vertices.size(), none);
  for (std::uint32_t t = 0; t < welded.triangles.size(); ++t) {
    for (const std::uint32_t v : welded.triangles[t]) {
      if (first_at[v] == none) first_at[v] = t;
      sets.unite(first_at[v], t);
    }
  }
  return number_sets(sets, welded.triangles.size());
}

Labels label_manifold_patches(const Mesh& welded, const EdgeTable& edges) {
  DisjointSets sets(welded.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto half_edges = edges.half_edges(e);
    if (half_edges.size() == 2) sets.unite(half_edges[0] / 3, half_edges[1] / 3);
  }
  return number_sets(sets, welded.triangles.size());
}

}  // namespace satcheck
