// The hull of any point set: distinct points, dimension by exact signs, then quickhull or, in a
// plane, A. M. Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions" (1979).
// Points are sorted by their coordinates first, so the result does not depend on their order.
#include "convex/convex_hull.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "base/edge_table.hpp"
#include "base/key_sort.hpp"
#include "base/numeric_range.hpp"
#include "base/patches.hpp"
#include "convex/quickhull.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

struct DistinctPoints {
  std::vector<Vec3> point;            // by x, then y, then z
  std::vector<std::uint32_t> source;  // the first input index of each
};

DistinctPoints distinct(const std::vector<Vec3>& points) {
  if (points.empty()) throw std::invalid_argument("the convex hull needs at least one point");
  require_in_range(points, "point");
  DistinctPoints result;
  for (const std::uint32_t i : order_by_coordinates(points)) {
    if (!result.point.empty() && points[i] == result.point.back()) continue;
    result.point.push_back(points[i]);
    result.source.push_back(i);
  }
  return result;
}

// The index with the largest `score` among those that `accept` allows; the size of the set if there is none. `accept`
// is exact. The score is rounded and only prefers well-shaped choices.
template <class Score, class Accept>
std::uint32_t best(const std::vector<Vec3>& points, Score score, Accept accept) {
  const auto count = static_cast<std::uint32_t>(points.size());
  std::uint32_t winner = 0;
  double highest = -1;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double s = score(points[i]);
    if (s > highest) {
      highest = s;
      winner = i;
    }
  }
  if (accept(points[winner])) return winner;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (accept(points[i])) return i;
  }
  return count;
}

// The corners of the hull of coplanar points, counter-clockwise along `drop_axis`.
std::vector<std::uint32_t> planar_hull(const std::vector<Vec3>& points, int drop_axis) {
  const int i = drop_axis == 2 ? 0 : drop_axis + 1;
  const int j = drop_axis == 0 ? 2 : drop_axis - 1;
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (points[a][i] != points[b][i]) return points[a][i] < points[b][i];
    return points[a][j] < points[b][j];
  });
  std::vector<std::uint32_t> chain;
  const auto extend = [&](std::uint32_t p, std::size_t base) {
    while (chain.size() >= base + 2 &&
           orientation_2d(points[chain[chain.size() - 2]], points[chain.back()], points[p],
                          drop_axis) <= 0) {
      chain.pop_back();
    }
    chain.push_back(p);
  };
  for (const std::uint32_t p : order) extend(p, 0);
  chain.pop_back();
  const std::size_t upper = chain.size();
  for (auto p = order.rbegin(); p != order.rend(); ++p) extend(*p, upper);
  chain.pop_back();
  return chain;
}

int widest_projection(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = rounded_normal(a, b, c);
  const Vec3 size{std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)};
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

Polytope lower_dimensional(const DistinctPoints& set, const std::vector<std::uint32_t>& corners,
                           int dimension) {
  Polytope result;
  result.dimension = dimension;
  for (const std::uint32_t i : corners) {
    result.vertices.push_back(set.point[i]);
    result.source.push_back(set.source[i]);
  }
  return result;
}

// The largest dimension of a simplex of these points, and `dimension` + 1 of them that span it.
struct FirstSimplex {
  int dimension;
  std::array<std::uint32_t, 4> corner;
};

FirstSimplex first_simplex(const std::vector<Vec3>& points) {
  const auto count = static_cast<std::uint32_t>(points.size());
  const std::uint32_t last = count - 1;
  if (count == 1) return {0, {0}};

  const Vec3 a = points.front(), b = points.back();  // both extreme
  const std::uint32_t third = best(
      points, [&](Vec3 p) { return norm_squared(cross(b - a, p - a)); },
      [&](Vec3 p) { return !collinear(a, b, p); });
  if (third == count) return {1, {0, last}};

  const Vec3 c = points[third];
  const Vec3 normal = rounded_normal(a, b, c);
  const std::uint32_t fourth = best(
      points, [&](Vec3 p) { return std::fabs(dot(normal, p - a)); },
      [&](Vec3 p) { return orientation(a, b, c, p) != 0; });
  if (fourth == count) return {2, {0, last, third}};
  return {3, {0, last, third, fourth}};
}

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

// Sets everything except `dimension` from outward triangles over `points`. Exactly coplanar neighbours become one face.
// Corners of fewer than three faces are not extreme and are left out.
// Vertices keep the order of `points`; faces are ordered by their corners.
void add_solid_faces(Polytope& polytope, const std::vector<Vec3>& points,
                     const std::vector<Triangle>& boundary,
                     const std::vector<std::uint32_t>& source) {
  const std::vector<std::uint32_t> twin = find_twins(points.size(), boundary);
  const std::vector<std::uint32_t> label = label_flat_parts(points, boundary, twin);
  std::vector<std::uint32_t> faces_at(points.size(), 0);
  auto polygons = find_polygons(boundary, Border{twin, label}, faces_at);

  std::vector<std::uint32_t> renumbered(points.size(), kNoIndex);
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

// Sets faces, edges and triangles of a planar polygon. Its vertices are already set, in cyclic order.
void add_flat_faces(Polytope& polytope) {
  std::vector<std::uint32_t> front(polytope.vertices.size());
  std::iota(front.begin(), front.end(), 0u);
  std::vector<std::uint32_t> back(front.rbegin(), front.rend());
  std::rotate(back.begin(), back.end() - 1, back.end());
  add_face(polytope, front);
  add_face(polytope, back);
  add_edges(polytope);
}

}  // namespace

Polytope convex_hull(const std::vector<Vec3>& points, Budget* budget) {
  const DistinctPoints set = distinct(points);
  const auto [dimension, corner] = first_simplex(set.point);
  if (dimension == 0) return lower_dimensional(set, {corner[0]}, 0);
  if (dimension == 1) return lower_dimensional(set, {corner[0], corner[1]}, 1);
  if (dimension == 2) {
    const int drop_axis = widest_projection(set.point[corner[0]], set.point[corner[1]], set.point[corner[2]]);
    Polytope flat = lower_dimensional(set, planar_hull(set.point, drop_axis), 2);
    add_flat_faces(flat);
    return flat;
  }
  Polytope solid;
  solid.dimension = 3;
  add_solid_faces(solid, set.point, quickhull(set.point, corner, budget), set.source);
  return solid;
}

HullTriangles hull_triangles(const std::vector<Vec3>& points, Budget* budget) {
  HullTriangles result{distinct(points).point, {}};
  const auto [dimension, corner] = first_simplex(result.points);
  if (dimension == 3) result.triangles = quickhull(result.points, corner, budget);
  return result;
}

}  // namespace satcheck
