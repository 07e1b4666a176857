#include "topology.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "edge_table.hpp"
#include "patches.hpp"
#include "predicates.hpp"

namespace satcheck {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

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

// For each vertex the first one of equal coordinates. -0.0 must have been made +0.0.
std::vector<std::uint32_t> first_of_equal(const std::vector<Vec3>& points) {
  const std::size_t capacity = std::bit_ceil(points.size() * 2 + 1);
  std::vector<std::uint32_t> slot(capacity, none), first(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::size_t at = hash_coordinates(points[i]) & (capacity - 1);
    while (slot[at] != none && !(points[slot[at]] == points[i])) at = (at + 1) & (capacity - 1);
    if (slot[at] == none) slot[at] = i;
    first[i] = slot[at];
  }
  return first;
}

struct Welding {
  Mesh mesh;
  std::size_t duplicate_vertices = 0, unreferenced_vertices = 0;
};

Welding weld_and_count(const Mesh& mesh) {
  Welding result;
  std::vector<Vec3> points = mesh.vertices;
  for (Vec3& p : points) p = p + Vec3{};  // -0.0 + 0.0 == +0.0
  const std::vector<std::uint32_t> first = first_of_equal(points);
  std::vector<bool> referenced(points.size(), false), kept(points.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      referenced[v] = true;
      kept[first[v]] = true;
    }
  }
  std::vector<std::uint32_t> renumbered(points.size(), none);
  for (std::uint32_t v = 0; v < points.size(); ++v) {
    if (!referenced[v]) ++result.unreferenced_vertices;
    if (first[v] != v) ++result.duplicate_vertices;
    if (!kept[v]) continue;
    renumbered[v] = static_cast<std::uint32_t>(result.mesh.vertices.size());
    result.mesh.vertices.push_back(points[v]);
  }
  result.mesh.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    result.mesh.triangles.push_back(
        {renumbered[first[t[0]]], renumbered[first[t[1]]], renumbered[first[t[2]]]});
  }
  return result;
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

void count_triangles(Topology& topology, const Mesh& welded) {
  std::vector<Triangle> sorted = welded.triangles;
  for (Triangle& t : sorted) {
    if (repeats_a_corner(t) ||
        collinear(welded.vertices[t[0]], welded.vertices[t[1]], welded.vertices[t[2]])) {
      ++topology.degenerate_triangles;
    }
    std::sort(t.begin(), t.end());
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    topology.duplicate_triangles += sorted[i] == sorted[i - 1] ? 1 : 0;
  }
}

}  // namespace

bool is_welded(const Mesh& mesh) {
  std::vector<Vec3> points = mesh.vertices;
  for (Vec3& p : points) p = p + Vec3{};  // as in weld_and_count()
  const std::vector<std::uint32_t> first = first_of_equal(points);
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    if (first[i] != i) return false;
  }
  return true;
}

Mesh weld(const Mesh& mesh) { return weld_and_count(mesh).mesh; }

Mesh sort(const Mesh& mesh) {
  struct Numbered {
    Vec3 point;
    std::uint32_t number;
  };
  std::vector<Numbered> order;
  order.reserve(mesh.vertices.size());
  for (const Vec3& p : mesh.vertices) order.push_back({p, static_cast<std::uint32_t>(order.size())});
  std::sort(order.begin(), order.end(), [](const Numbered& a, const Numbered& b) {
    return a.point == b.point ? a.number < b.number : coordinates_less(a.point, b.point);
  });
  Mesh result;
  result.vertices.reserve(order.size());
  std::vector<std::uint32_t> place(order.size());
  for (const Numbered& v : order) {
    place[v.number] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(v.point);
  }
  result.triangles = mesh.triangles;
  for (Triangle& t : result.triangles) {
    for (std::uint32_t& v : t) v = place[v];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  }
  std::sort(result.triangles.begin(), result.triangles.end());
  return result;
}

Topology measure_topology(const Mesh& mesh) {
  const Welding welding = weld_and_count(mesh);
  const Mesh& welded = welding.mesh;
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  Topology topology;
  topology.vertices = mesh.vertices.size();
  topology.triangles = mesh.triangles.size();
  topology.duplicate_vertices = welding.duplicate_vertices;
  topology.unreferenced_vertices = welding.unreferenced_vertices;
  topology.components = label_components(welded, edges).count;
  count_edges(topology, edges);
  count_triangles(topology, welded);
  if (topology.closed && topology.oriented) {
    topology.volume = signed_volume(welded.vertices, welded.triangles);
  }
  topology.solid = topology.volume != 0;
  return topology;
}

}  // namespace satcheck
