#include "mesh/inspection.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "base/edge_table.hpp"
#include "base/large_pages.hpp"
#include "base/patches.hpp"
#include "exact/predicates.hpp"
#include "mesh/cracks.hpp"
#include "mesh/facing.hpp"
#include "mesh/orient.hpp"

namespace satcheck {
namespace {

// A half-edge at its lower corner.
struct Side {
  std::uint32_t upper, triangle;
};

// The edges opposite to the lowest corners. Edges that ascend from a vertex are stored separately from those that
// descend to it.
class ThirdSides {
 public:
  ThirdSides(std::size_t vertex_count, const std::vector<Triangle>& triangles)
      : start_(with_room<std::uint32_t>(2 * vertex_count + 1)), sides_(unwritten<Side>(triangles.size())) {
    start_.resize(2 * vertex_count + 1);
    for (const Triangle& t : triangles) ++start_[list_of(t)];
    std::inclusive_scan(start_.begin(), start_.end(), start_.begin());
    // From the back, so that each start ends up where its list starts.
    for (std::size_t t = triangles.size(); t-- > 0;) {
      const auto [a, b, c] = triangles[t];
      sides_[--start_[list_of(triangles[t])]] = {std::max(b, c), static_cast<std::uint32_t>(t)};
    }
  }

  std::span<const Side> ascending(std::size_t vertex) const { return list(2 * vertex); }
  std::span<const Side> descending(std::size_t vertex) const { return list(2 * vertex + 1); }

 private:
  static std::size_t list_of(const Triangle& t) { return 2 * std::size_t{std::min(t[1], t[2])} + (t[1] > t[2] ? 1 : 0); }
  std::span<const Side> list(std::size_t number) const {
    return {sides_.get() + start_[number], sides_.get() + start_[number + 1]};
  }

  std::vector<std::uint32_t> start_;
  std::unique_ptr<Side[]> sides_;
};

// Finds the two triangles of each edge, vertex by vertex, and unites them.
class Pairing {
 public:
  Pairing(std::size_t vertex_count, const std::vector<Triangle>& triangles)
      : triangles_(triangles), open_(zeroed<Open>(vertex_count)), sets_(triangles.size()), parts_(triangles.size()) {}

  // Starts an edge that ascends from this vertex. False: another one does the same.
  bool begin(std::uint32_t vertex, Side ascending) {
    Open& open = open_[ascending.upper];
    if (open.behind == vertex + 1) return false;
    open = {vertex + 1, ascending.triangle};
    ++waiting_;
    return true;
  }

  // Ends an edge that descends to this vertex. False: no waiting edge runs the other way, or it belongs to a copy of
  // the triangle.
  bool end(std::uint32_t vertex, Side descending) {
    Open& open = open_[descending.upper];
    if (open.behind != vertex + 1) return false;
    open.behind = 0;
    --waiting_;
    // They share two corners, so these sums tell whether the third ones differ.
    const auto corner_sum = [&](std::uint32_t triangle) {
      const Triangle& t = triangles_[triangle];
      return std::uint64_t{t[0]} + t[1] + t[2];
    };
    parts_ -= sets_.unite(open.triangle, descending.triangle) ? 1 : 0;
    return corner_sum(open.triangle) != corner_sum(descending.triangle);
  }

  bool all_paired() const { return waiting_ == 0; }
  std::size_t parts() const { return parts_; }

 private:
  // The edge that waits at its upper corner for its opposite edge.
  struct Open {
    std::uint32_t behind;  // the number after that of its lower corner; 0: none waits
    std::uint32_t triangle;
  };

  const std::vector<Triangle>& triangles_;
  std::unique_ptr<Open[], Free> open_;
  DisjointSets sets_;
  std::size_t waiting_ = 0, parts_;
};

// The number of connected parts; empty if an edge has not exactly two matching triangles.
std::optional<std::size_t> count_parts(std::size_t vertex_count, const std::vector<Triangle>& triangles) {
  const ThirdSides thirds(vertex_count, triangles);
  Pairing pairing(vertex_count, triangles);
  std::uint32_t first = 0, last = 0;  // the triangles whose lowest corner is the vertex
  for (std::uint32_t v = 0; v < vertex_count; ++v, first = last) {
    bool fits = true;
    for (; last < triangles.size() && triangles[last][0] == v; ++last) fits &= pairing.begin(v, {triangles[last][1], last});
    for (const Side side : thirds.ascending(v)) fits &= pairing.begin(v, side);
    for (std::uint32_t t = first; t < last; ++t) fits &= pairing.end(v, {triangles[t][2], t});
    for (const Side side : thirds.descending(v)) fits &= pairing.end(v, side);
    if (!fits || !pairing.all_paired()) return std::nullopt;
  }
  return pairing.parts();
}

// A fast path for the topology of closed manifold meshes, which most meshes are: the result of measure_welded() for the
// output of weld_and_sort(). Empty unless every edge has two triangles, with different corners, that run it in opposite
// directions. Edges are listed at their lower corner. Two edges of a triangle start or end at its lowest corner, and
// triangles are sorted by that corner. Only the third edges have to be distributed.
std::optional<Topology> measure_sorted_manifold(const Mesh& sorted) {
  const std::vector<Triangle>& triangles = sorted.triangles;
  if (triangles.empty() || std::any_of(triangles.begin(), triangles.end(), repeats_a_corner)) return std::nullopt;
  const std::optional<std::size_t> parts = count_parts(sorted.vertices.size(), triangles);
  if (!parts) return std::nullopt;
  Topology topology;
  topology.vertices = sorted.vertices.size();
  topology.triangles = triangles.size();
  topology.components = *parts;
  topology.closed = topology.manifold = topology.oriented = true;
  VolumeSum volume(sorted.vertices[triangles[0][0]]);
  for (const Triangle& t : triangles) {
    const Vec3 a = sorted.vertices[t[0]], b = sorted.vertices[t[1]], c = sorted.vertices[t[2]];
    topology.degenerate_triangles += collinear(a, b, c) ? 1 : 0;
    volume.add(a, b, c);
  }
  const auto certain = volume.volume();
  topology.volume = certain ? *certain : signed_volume(sorted.vertices, triangles);
  topology.solid = topology.volume != 0;
  return topology;
}

Topology measure_sorted(const Mesh& sorted) {
  const auto plain = measure_sorted_manifold(sorted);
  return plain ? *plain : measure_welded(sorted, EdgeTable(sorted.vertices.size(), sorted.triangles));
}

// The most steps of an inspection, about two seconds, and of each triangle in addition.
constexpr std::uint64_t kMeshWork = 2'000'000'000, kWorkOfTriangle = 100'000;

Budget budget_of_inspection(const Mesh& mesh, const Poll& poll) {
  return Budget::that_stops(std::min(kMeshWork + kWorkOfTriangle * mesh.triangles.size(), kMostSteps), poll);
}

bool has_boundary(const Topology& topology) { return !topology.closed || !topology.oriented; }

// Without those of flat parts.
std::vector<Hole> holes_of(const Inspection& inspection, Budget& budget) {
  if (!inspection.doubtful && !has_boundary(inspection.repaired)) return {};
  Mesh mesh = inspection.mesh;
  double_triangles(mesh, flat_parts(inspection.mesh));
  if (!inspection.doubtful) return find_holes(mesh);
  return find_holes(mesh, facing_of(inspection.mesh, &budget).doubtful);
}

Inspection sealed(Inspection given, double width, Budget& budget) {
  given.cracks = seal_cracks(given.mesh, width, &budget);
  if (given.cracks != 0) given.repaired = measure_topology(given.mesh);
  return given;
}

void orient_mesh(Inspection& result, Budget& budget) {
  result.doubtful = false;
  Mesh oriented = orient(result.mesh, &budget, &result.doubtful);
  if (oriented.triangles != result.mesh.triangles || oriented.vertices != result.mesh.vertices) {
    result.mesh = std::move(oriented);
    result.turned = true;
    result.repaired = measure_topology(result.mesh);
  }
  if (result.doubtful) result.repaired.solid = false;
}

}  // namespace

// The winding of a mesh with a boundary is judged with its cracks closed, because edges beside a T-junction may have two
// triangles that belong to different neighbours.
Inspection inspect(MeshView mesh, bool orient_it, const Poll& poll) {
  Inspection result;
  result.mesh = weld_and_sort(mesh);
  result.topology = result.repaired = measure_sorted(result.mesh);
  if (result.topology.is_plain_solid()) return result;
  Budget budget = budget_of_inspection(result.mesh, poll);
  if (orient_it && result.topology.closed) orient_mesh(result, budget);
  result.holes = holes_of(result, budget);
  return result;
}

Inspection with_cracks_closed(Inspection given, bool orient_it, double width, const Poll& poll) {
  if (!has_boundary(given.repaired)) return given;
  Budget budget = budget_of_inspection(given.mesh, poll);
  Inspection result = sealed(given, width, budget);
  if (orient_it && !result.repaired.oriented) {
    orient_mesh(given, budget);
    result = sealed(std::move(given), width, budget);
  }
  if (orient_it) orient_mesh(result, budget);
  result.holes = holes_of(result, budget);
  return result;
}

}  // namespace satcheck
