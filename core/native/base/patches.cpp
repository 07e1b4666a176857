#include "base/patches.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

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

struct SetAtEdge {
  std::uint32_t set;
  int balance;  // number of its triangles that run the edge upward, minus downward
};

void find_sets_at(std::size_t edge, const Labels& labels, const EdgeTable& edges, std::vector<SetAtEdge>& sets) {
  sets.clear();
  for (const std::uint32_t h : edges.half_edges(edge)) {
    sets.push_back({labels.of_triangle[h / 3], edges.ascends(h) ? 1 : -1});
  }
  std::ranges::sort(sets, {}, &SetAtEdge::set);
  std::size_t count = 0;
  for (const SetAtEdge& at : sets) {
    if (count > 0 && sets[count - 1].set == at.set) {
      sets[count - 1].balance += at.balance;
    } else {
      sets[count++] = at;
    }
  }
  sets.resize(count);
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

std::vector<bool> find_open_sets(const Labels& labels, const EdgeTable& edges) {
  std::vector<bool> open(labels.count, false);
  std::vector<SetAtEdge> sets;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    find_sets_at(e, labels, edges, sets);
    for (const auto& [set, balance] : sets) open[set] = open[set] || balance != 0;
  }
  return open;
}

std::vector<bool> find_flaps(const Labels& labels, const EdgeTable& edges) {
  std::vector<std::vector<SetAtEdge>> rims;  // edges at which a set is open
  std::vector<std::size_t> left_at;  // of its sets, those that are no flaps
  std::vector<std::vector<std::size_t>> rims_of(labels.count);
  std::vector<std::uint32_t> next;
  std::vector<SetAtEdge> sets;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    find_sets_at(e, labels, edges, sets);
    if (std::ranges::all_of(sets, [](const SetAtEdge& s) { return s.balance == 0; })) continue;
    if (sets.size() == 1) next.push_back(sets[0].set);
    for (const SetAtEdge& s : sets) rims_of[s.set].push_back(rims.size());
    rims.push_back(sets);
    left_at.push_back(sets.size());
  }
  std::vector<bool> is_flap(labels.count, false);
  while (!next.empty()) {
    const std::uint32_t set = next.back();
    next.pop_back();
    if (is_flap[set]) continue;
    is_flap[set] = true;
    for (const std::size_t rim : rims_of[set]) {
      if (--left_at[rim] != 1) continue;
      const auto last = std::ranges::find_if(rims[rim], [&](const SetAtEdge& s) { return !is_flap[s.set]; });
      if (last->balance != 0) next.push_back(last->set);
    }
  }
  return is_flap;
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
