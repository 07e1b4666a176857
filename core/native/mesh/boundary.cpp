#include "mesh/boundary.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "base/patches.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

// The boundary edges that start at each vertex, taken one by one.
class BoundaryEdges {
 public:
  BoundaryEdges(const Mesh& welded, const EdgeTable& edges) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
      int balance = 0;
      for (const std::uint32_t h : edges.half_edges(e)) balance += edges.ascends(h) ? 1 : -1;
      if (balance == 0) continue;
      const std::uint32_t h = edges.half_edges(e)[0];
      const Triangle& t = welded.triangles[h / 3];
      auto [low, high] = std::minmax(t[h % 3], t[(h % 3 + 1) % 3]);
      for (int k = 0; k < std::abs(balance); ++k) {
        balance > 0 ? starts_[low].push_back(high) : starts_[high].push_back(low);
      }
    }
    for (auto& [vertex, ends] : starts_) std::sort(ends.begin(), ends.end(), std::greater<>());
  }

  std::vector<std::uint32_t> starts() const {
    std::vector<std::uint32_t> result;
    for (const auto& [vertex, ends] : starts_) result.push_back(vertex);
    return result;
  }

  // The end of an edge from this vertex, which is gone then.
  std::optional<std::uint32_t> take(std::uint32_t vertex) {
    auto& ends = starts_[vertex];
    if (ends.empty()) return std::nullopt;
    const std::uint32_t end = ends.back();
    ends.pop_back();
    return end;
  }

 private:
  std::map<std::uint32_t, std::vector<std::uint32_t>> starts_;
};

}  // namespace

// A walk along the boundary; a vertex that it meets again closes a loop, which is taken out of the walk.
std::vector<BoundaryLoop> boundary_loops(const Mesh& welded, const EdgeTable& edges) {
  BoundaryEdges left(welded, edges);
  std::vector<BoundaryLoop> loops;
  std::map<std::uint32_t, std::size_t> place;  // of a vertex on the walk
  for (const std::uint32_t start : left.starts()) {
    std::vector<std::uint32_t> walk{start};
    place = {{start, 0}};
    while (const auto next = left.take(walk.back())) {
      const auto [met, is_new] = place.try_emplace(*next, walk.size());
      if (is_new) {
        walk.push_back(*next);
        continue;
      }
      const auto first = walk.begin() + static_cast<std::ptrdiff_t>(met->second);
      loops.emplace_back(first, walk.end());
      for (auto v = first + 1; v != walk.end(); ++v) place.erase(*v);
      walk.erase(first + 1, walk.end());
    }
  }
  return loops;
}

std::vector<Triangle> fan(const BoundaryLoop& loop) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) triangles.push_back({loop[0], loop[i + 1], loop[i]});
  return triangles;
}

namespace {

// The largest first.
std::vector<Hole> make_holes(const Mesh& mesh, const std::vector<BoundaryLoop>& loops) {
  std::map<std::uint32_t, std::uint32_t> first_at;  // a vertex: the first loop there
  DisjointSets sets(loops.size());
  for (std::uint32_t i = 0; i < loops.size(); ++i) {
    for (const std::uint32_t v : loops[i]) sets.unite(first_at.try_emplace(v, i).first->second, i);
  }
  std::vector<Hole> holes;
  std::vector<std::uint32_t> hole_of(loops.size(), kNowhere);
  for (std::uint32_t i = 0; i < loops.size(); ++i) {
    const std::uint32_t set = sets.find(i);
    if (hole_of[set] == kNowhere) {
      hole_of[set] = static_cast<std::uint32_t>(holes.size());
      holes.emplace_back();
    }
    Hole& hole = holes[hole_of[set]];
    hole.loops.push_back(loops[i]);
    for (const std::uint32_t v : loops[i]) hole.box.include(mesh.vertices[v]);
  }
  const auto key = [](const Hole& h) {
    const Vec3 c = h.centre();
    return std::tuple(-h.diameter(), c.x, c.y, c.z);
  };
  std::stable_sort(holes.begin(), holes.end(), [&](const Hole& g, const Hole& h) { return key(g) < key(h); });
  return holes;
}

// Which parts have an edge of the boundary.
std::vector<bool> open_parts_of(const EdgeTable& edges, const Labels& parts) {
  std::vector<bool> open(parts.count, false);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    int balance = 0;
    for (const std::uint32_t h : edges.half_edges(e)) balance += edges.ascends(h) ? 1 : -1;
    if (balance != 0) open[parts.of_triangle[edges.half_edges(e)[0] / 3]] = true;
  }
  return open;
}

bool is_flat(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  const auto corners_of = [&](std::uint32_t t) {
    const Triangle& v = mesh.triangles[t];
    return std::array<Vec3, 3>{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
  };
  const auto has_area = [&](std::uint32_t t) {
    const auto c = corners_of(t);
    return !collinear(c[0], c[1], c[2]);
  };
  const auto first = std::find_if(triangles.begin(), triangles.end(), has_area);
  if (first == triangles.end()) return true;
  const auto plane = corners_of(*first);
  return std::all_of(triangles.begin(), triangles.end(), [&](std::uint32_t t) {
    const auto c = corners_of(t);
    return std::all_of(c.begin(), c.end(), [&](Vec3 p) { return orientation(plane[0], plane[1], plane[2], p) == 0; });
  });
}

}  // namespace

void double_flat_parts(Mesh& welded) {
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  const Labels parts = label_vertex_components(welded);
  const std::vector<bool> open = open_parts_of(edges, parts);
  std::vector<Triangle> backs;
  std::uint32_t number = 0;
  for (const auto& triangles : parts.members()) {
    if (!open[number++] || !is_flat(welded, triangles)) continue;
    for (const std::uint32_t t : triangles) {
      const Triangle& v = welded.triangles[t];
      backs.push_back({v[0], v[2], v[1]});
    }
  }
  welded.triangles.insert(welded.triangles.end(), backs.begin(), backs.end());
}

std::vector<Hole> find_holes(const Mesh& welded) {
  Mesh mesh = welded;
  double_flat_parts(mesh);
  return make_holes(mesh, boundary_loops(mesh, EdgeTable(mesh.vertices.size(), mesh.triangles)));
}

}  // namespace satcheck
