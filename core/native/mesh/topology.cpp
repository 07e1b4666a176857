#include "mesh/topology.hpp"

#include <algorithm>
#include <bit>
#include <memory>
#include <utility>

#include "base/edge_table.hpp"
#include "base/key_sort.hpp"
#include "base/large_pages.hpp"
#include "base/patches.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

std::uint64_t hash_coordinates(Vec3 p) {
  // Multiply and fold; the constant is 2^64 divided by the golden ratio.
  constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15u;
  std::uint64_t h = 0;
  for (const double c : {p.x, p.y, p.z}) {
    h = (h ^ std::bit_cast<std::uint64_t>(c)) * kFactor;
    h ^= h >> 29;
  }
  return h;
}

// A table of points. For a point it finds the first point with the same coordinates.
class FirstOfEqual {
 public:
  explicit FirstOfEqual(std::size_t count) : slot_(std::bit_ceil(count * 2 + 1), kNoIndex) {}

  // The first equal point among the queried points, including this one.
  std::uint32_t of(const std::vector<Vec3>& points, std::uint32_t i) {
    const Vec3 p = points[i] + Vec3{};  // -0.0 + 0.0 == +0.0
    std::size_t at = hash_coordinates(p) & (slot_.size() - 1);
    while (slot_[at] != kNoIndex && !(points[slot_[at]] == p)) at = (at + 1) & (slot_.size() - 1);
    if (slot_[at] == kNoIndex) slot_[at] = i;
    return slot_[at];
  }

 private:
  std::vector<std::uint32_t> slot_;
};

std::vector<std::uint32_t> first_of_equal(const std::vector<Vec3>& points) {
  std::vector<std::uint32_t> first(points.size());
  FirstOfEqual known(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) first[i] = known.of(points, i);
  return first;
}

// Points with equal coordinates are then equal bit for bit, because -0.0 == 0.0.
std::vector<Vec3> without_negative_zeros(std::vector<Vec3> points) {
  for (Vec3& p : points) p = p + Vec3{};  // -0.0 + 0.0 == +0.0
  return points;
}

// 0 or 1 for each vertex. Bytes, because setting a bit would have to read its neighbours.
std::vector<unsigned char> find_referenced(MeshView mesh) {
  std::vector<unsigned char> referenced(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) referenced[v] = 1;
  }
  return referenced;
}

void count_edges(Topology& topology, const EdgeTable& edges) {
  bool all_even = true, all_two = true;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto half_edges = edges.half_edges(e);
    const std::size_t count = half_edges.size();
    std::size_t ascending = 0;
    for (const std::uint32_t h : half_edges) ascending += edges.ascends(h) ? 1 : 0;
    const std::size_t difference = ascending * 2 > count ? ascending * 2 - count : count - ascending * 2;
    topology.boundary_edges += count == 1 ? 1 : 0;
    topology.nonmanifold_edges += count > 2 ? 1 : 0;
    topology.misoriented_edges += difference != count % 2 ? 1 : 0;
    all_even = all_even && count % 2 == 0;
    all_two = all_two && count == 2;
  }
  topology.closed = edges.size() > 0 && all_even;
  topology.manifold = edges.size() > 0 && all_two;
  topology.oriented = topology.misoriented_edges == 0;
}

// Copies of a triangle share their edges and the corner opposite to each.
bool may_have_copies(const Mesh& welded, const EdgeTable& edges) {
  const auto across = [&](std::uint32_t h) { return welded.triangles[h / 3][(h % 3 + 2) % 3]; };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    if (h.size() > 2 || (h.size() == 2 && across(h[0]) == across(h[1]))) return true;
  }
  return false;
}

void count_triangles(Topology& topology, const Mesh& welded, const EdgeTable& edges) {
  std::size_t pointed = 0;  // triangles that name a corner twice: they have no edges
  for (const Triangle& t : welded.triangles) {
    if (repeats_a_corner(t)) {
      ++pointed;
    } else if (collinear(welded.vertices[t[0]], welded.vertices[t[1]], welded.vertices[t[2]])) {
      ++topology.degenerate_triangles;
    }
  }
  topology.degenerate_triangles += pointed;
  if (pointed < 2 && !may_have_copies(welded, edges)) return;
  std::vector<Triangle> sorted = welded.triangles;
  for (Triangle& t : sorted) std::sort(t.begin(), t.end());
  sort_triangles(sorted, welded.vertices.size());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    topology.duplicate_triangles += sorted[i] == sorted[i - 1] ? 1 : 0;
  }
}

// Renumbers vertex v to place[v], starts each triangle at its lowest corner, and sorts the triangles.
std::vector<Triangle> sorted_triangles(std::span<const Triangle> triangles, const std::uint32_t* place,
                                       std::size_t vertex_count) {
  std::vector<Triangle> result = with_room<Triangle>(triangles.size());
  for (const Triangle& t : triangles) {
    const std::uint32_t a = place[t[0]], b = place[t[1]], c = place[t[2]];
    // Without branches, which would often be mispredicted.
    const std::uint32_t round[] = {a, b, c, a, b};
    const std::size_t lowest = static_cast<std::size_t>((b < a) | (c < a)) << static_cast<unsigned>(c < b);
    result.push_back({round[lowest], round[lowest + 1], round[lowest + 2]});
  }
  sort_triangles(result, vertex_count);
  return result;
}

}  // namespace

bool is_welded(const Mesh& mesh) {
  FirstOfEqual first(mesh.vertices.size());
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    if (first.of(mesh.vertices, i) != i) return false;
  }
  return true;
}

Mesh weld(const Mesh& mesh) {
  const std::vector<unsigned char> referenced = find_referenced(mesh);
  std::vector<Vec3> points = without_negative_zeros(mesh.vertices);
  if (strictly_ascending(points) && std::find(referenced.begin(), referenced.end(), 0) == referenced.end()) {
    return {std::move(points), mesh.triangles};
  }
  Mesh result;
  const std::vector<std::uint32_t> first = first_of_equal(points);
  std::vector<bool> kept(points.size(), false);
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (referenced[v]) kept[first[v]] = true;
  }
  std::vector<std::uint32_t> renumbered(points.size(), kNoIndex);
  for (std::uint32_t v = 0; v < points.size(); ++v) {
    if (!kept[v]) continue;
    renumbered[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(points[v]);
  }
  result.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    result.triangles.push_back(
        {renumbered[first[t[0]]], renumbered[first[t[1]]], renumbered[first[t[2]]]});
  }
  return result;
}

Mesh sort(const Mesh& mesh) {
  Mesh result;
  result.vertices.reserve(mesh.vertices.size());
  std::vector<std::uint32_t> place(mesh.vertices.size());
  for (const std::uint32_t v : order_by_coordinates(mesh.vertices)) {
    place[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(mesh.vertices[v]);
  }
  result.triangles = sorted_triangles(mesh.triangles, place.data(), result.vertices.size());
  return result;
}

Mesh weld_and_sort(MeshView mesh) {
  const std::span<const Vec3> points = mesh.vertices;
  const std::vector<unsigned char> referenced = find_referenced(mesh);
  Mesh result;
  result.vertices = with_room<Vec3>(points.size());
  const auto place = unwritten<std::uint32_t>(points.size());
  for (const std::uint32_t v : order_by_coordinates(points)) {
    if (!referenced[v]) continue;
    const Vec3 p = points[v] + Vec3{};  // -0.0 + 0.0 == +0.0
    if (result.vertices.empty() || result.vertices.back() != p) result.vertices.push_back(p);
    place[v] = static_cast<std::uint32_t>(result.vertices.size() - 1);
  }
  result.triangles = sorted_triangles(mesh.triangles, place.get(), result.vertices.size());
  return result;
}

Topology measure_topology(const Mesh& mesh) {
  const Mesh welded = weld(mesh);
  Topology topology = measure_welded(welded, EdgeTable(welded.vertices.size(), welded.triangles));
  topology.vertices = mesh.vertices.size();
  return topology;
}

Topology measure_welded(const Mesh& welded, const EdgeTable& edges) {
  Topology topology;
  topology.vertices = welded.vertices.size();
  topology.triangles = welded.triangles.size();
  topology.components = label_components(welded, edges).count;
  count_edges(topology, edges);
  count_triangles(topology, welded, edges);
  if (topology.closed && topology.oriented) {
    topology.volume = signed_volume(welded.vertices, welded.triangles);
  }
  topology.solid = topology.volume != 0;
  return topology;
}

}  // namespace satcheck
