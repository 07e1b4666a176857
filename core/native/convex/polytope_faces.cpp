#include "convex/polytope_faces.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/edge_table.hpp"
#include "base/patches.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// Half-edge h = 3 t + i runs from corner i to corner i + 1 of triangle t.
std::uint32_t next_half_edge(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }

std::uint64_t directed_key(std::uint32_t tail, std::uint32_t head) {
  return (static_cast<std::uint64_t>(tail) << 32) | head;
}

// For each half-edge of a closed manifold the opposite half-edge.
std::vector<std::uint32_t> find_twins(std::size_t vertex_count,
                                      const std::vector<Triangle>& triangles) {
  const EdgeTable edges(vertex_count, triangles);
  std::vector<std::uint32_t> twin(triangles.size() * 3);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    twin[h[0]] = h[1];
    twin[h[1]] = h[0];
  }
  return twin;
}

// A label per triangle, equal on exactly coplanar neighbours.
std::vector<std::uint32_t> label_flat_parts(const std::vector<Vec3>& points,
                                            const std::vector<Triangle>& triangles,
                                            const std::vector<std::uint32_t>& twin) {
  DisjointSets sets(triangles.size());
  for (std::uint32_t h = 0; h < twin.size(); ++h) {
    if (twin[h] < h) continue;
    const Triangle& t = triangles[h / 3];
    const std::uint32_t opposite = next_half_edge(next_half_edge(twin[h]));
    const Vec3 apex = points[triangles[opposite / 3][opposite % 3]];
    if (orientation(points[t[0]], points[t[1]], points[t[2]], apex) == 0) {
      sets.unite(twin[h] / 3, h / 3);
    }
  }
  std::vector<std::uint32_t> label(triangles.size());
  for (std::uint32_t t = 0; t < label.size(); ++t) label[t] = sets.find(t);
  return label;
}

// A half-edge whose two sides belong to different flat parts.
struct Border {
  const std::vector<std::uint32_t>& twin;
  const std::vector<std::uint32_t>& label;

  bool contains(std::uint32_t h) const { return label[h / 3] != label[twin[h] / 3]; }

  // The border half-edge of the same flat part that starts where `h` ends.
  std::uint32_t next(std::uint32_t h) const {
    h = next_half_edge(h);
    while (!contains(h)) h = next_half_edge(twin[h]);
    return h;
  }
};

void add_face(Polytope& polytope, const std::vector<std::uint32_t>& polygon) {
  const std::size_t n = polygon.size();
  const std::vector<Vec3>& v = polytope.vertices;
  const Vec3 normal = rounded_normal(v[polygon[0]], v[polygon[n / 3]], v[polygon[2 * n / 3]]);
  const Vec3 scaled = normal * (1 / max_abs(normal));
  polytope.face_normal.push_back(scaled * (1 / norm(scaled)));
  if (polytope.face_offset.empty()) polytope.face_offset.push_back(0);
  polytope.face_vertex.insert(polytope.face_vertex.end(), polygon.begin(), polygon.end());
  polytope.face_offset.push_back(static_cast<std::uint32_t>(polytope.face_vertex.size()));
  for (std::size_t i = 1; i + 1 < n; ++i) {
    polytope.triangles.push_back({polygon[0], polygon[i], polygon[i + 1]});
  }
}

void add_edges(Polytope& polytope) {
  struct Side {
    std::uint64_t key;
    std::uint32_t face;
    bool ascending;
  };
  std::vector<Side> sides;
  for (std::uint32_t f = 0; f < polytope.face_count(); ++f) {
    const std::uint32_t first = polytope.face_offset[f], last = polytope.face_offset[f + 1];
    for (std::uint32_t i = first; i < last; ++i) {
      const std::uint32_t a = polytope.face_vertex[i];
      const std::uint32_t b = polytope.face_vertex[i + 1 == last ? first : i + 1];
      sides.push_back({directed_key(std::min(a, b), std::max(a, b)), f, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.key != b.key ? a.key < b.key : a.ascending > b.ascending;
  });
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
    const auto tail = static_cast<std::uint32_t>(sides[i].key >> 32);
    const auto head = static_cast<std::uint32_t>(sides[i].key);
    polytope.edges.push_back({tail, head, sides[i].face, sides[i + 1].face});
  }
}

// The border loops of the flat parts, as indices of `points`, keeping only corners of at least
// three faces.
std::vector<std::vector<std::uint32_t>> find_polygons(const std::vector<Triangle>& boundary,
                                                      const Border& border,
                                                      std::vector<std::uint32_t>& faces_at) {
  std::vector<std::vector<std::uint32_t>> loops;
  std::vector<bool> visited(border.twin.size(), false);
  for (std::uint32_t h = 0; h < border.twin.size(); ++h) {
    if (visited[h] || !border.contains(h)) continue;
    std::vector<std::uint32_t>& loop = loops.emplace_back();
    for (std::uint32_t e = h; !visited[e]; e = border.next(e)) {
      visited[e] = true;
      loop.push_back(boundary[e / 3][e % 3]);
      ++faces_at[loop.back()];
    }
  }
  for (auto& loop : loops) {
    std::erase_if(loop, [&](std::uint32_t v) { return faces_at[v] < 3; });
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

}  // namespace

void add_solid_faces(Polytope& polytope, const std::vector<Vec3>& points,
                     const std::vector<Triangle>& boundary,
                     const std::vector<std::uint32_t>& source) {
  const std::vector<std::uint32_t> twin = find_twins(points.size(), boundary);
  const std::vector<std::uint32_t> label = label_flat_parts(points, boundary, twin);
  std::vector<std::uint32_t> faces_at(points.size(), 0);
  auto polygons = find_polygons(boundary, Border{twin, label}, faces_at);

  std::vector<std::uint32_t> renumbered(points.size(), none);
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    if (faces_at[p] < 3) continue;
    renumbered[p] = static_cast<std::uint32_t>(polytope.vertices.size());
    polytope.vertices.push_back(points[p]);
    polytope.source.push_back(source[p]);
  }
  for (auto& polygon : polygons) {
    for (std::uint32_t& v : polygon) v = renumbered[v];
    add_face(polytope, polygon);
  }
  add_edges(polytope);
}

void add_flat_faces(Polytope& polytope) {
  std::vector<std::uint32_t> front(polytope.vertices.size());
  std::iota(front.begin(), front.end(), 0u);
  std::vector<std::uint32_t> back(front.rbegin(), front.rend());
  std::rotate(back.begin(), back.end() - 1, back.end());
  add_face(polytope, front);
  add_face(polytope, back);
  add_edges(polytope);
}

}  // namespace satcheck
