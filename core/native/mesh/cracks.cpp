#include "mesh/cracks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/key_sort.hpp"
#include "base/patches.hpp"
#include "mesh/boundary.hpp"
#include "mesh/bvh.hpp"

namespace satcheck {
namespace {

// A share of the size of a mesh. Wider cracks are not closed, because such coarse coordinates no longer describe a
// shape.
constexpr double kThinBeside = 0x1p-10;
// Vertices on edges, for each vertex of the boundary. A T-junction of two faces has one; many edges along one line have
// more, and stay as they are.
constexpr std::size_t kMostSplits = 16;
// The same for vertices that are looked at: those of a cluster are near each of its edges.
constexpr std::size_t kMostVisits = 200;
// Measured steps of a vertex that is held against an edge, or another vertex.
constexpr std::uint64_t kVertexWork = 50;

double distance(Vec3 p, Vec3 q) { return norm(q - p); }

double distance_to_segment(Vec3 x, Vec3 p, Vec3 q) {
  const Vec3 along = q - p;
  const double size = dot(along, along);
  const double share = size > 0 ? std::clamp(dot(x - p, along) / size, 0.0, 1.0) : 0;
  return distance(x, p + along * share);
}

// Whether all vertices of the loop lie within `width` of one segment.
bool bounds_no_area(const Mesh& mesh, const BoundaryLoop& loop, double width) {
  const auto at = [&](std::uint32_t v) { return mesh.vertices[v]; };
  const auto farthest_from = [&](Vec3 p) {
    return *std::max_element(loop.begin(), loop.end(),
                             [&](auto u, auto v) { return distance(p, at(u)) < distance(p, at(v)); });
  };
  const Vec3 p = at(farthest_from(at(loop[0]))), q = at(farthest_from(p));
  return std::all_of(loop.begin(), loop.end(), [&](auto v) { return distance_to_segment(at(v), p, q) <= width; });
}

int widest_axis(const Mesh& mesh, const std::vector<std::uint32_t>& vertices) {
  Aabb box;
  for (const std::uint32_t v : vertices) box.include(mesh.vertices[v]);
  return box.widest_axis();
}

std::vector<std::uint32_t> vertices_of(const std::vector<BoundaryLoop>& loops) {
  std::vector<std::uint32_t> vertices;
  for (const BoundaryLoop& loop : loops) vertices.insert(vertices.end(), loop.begin(), loop.end());
  sort_once(vertices);
  return vertices;
}

Bvh tree_of(const Mesh& mesh, const std::vector<std::uint32_t>& vertices) {
  std::vector<Aabb> points;
  for (const std::uint32_t v : vertices) points.push_back({mesh.vertices[v], mesh.vertices[v]});
  return build_bvh_by_form(points);
}

// Whether the segment may come within `reach` of the box along each axis.
bool may_pass(Vec3 p, Vec3 q, const Aabb& box, double reach) {
  double enters = 0, leaves = 1;
  for (int k = 0; k < 3; ++k) {
    const double low = box.min[k] - reach - p[k], high = box.max[k] + reach - p[k], along = q[k] - p[k];
    if (along == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    enters = std::max(enters, std::min(low / along, high / along));
    leaves = std::min(leaves, std::max(low / along, high / along));
  }
  return enters <= leaves;
}

// Closes T-junctions: each boundary edge that passes within the width of other vertices of the boundary gets triangles
// that replace it by edges from vertex to vertex. Several T-junctions often lie on one loop, which then bounds no
// single segment.
void split_edges(Mesh& welded, const std::vector<BoundaryLoop>& loops, double width, Budget* budget) {
  const std::vector<std::uint32_t> vertices = vertices_of(loops);
  const Bvh tree = tree_of(welded, vertices);
  const auto at = [&](std::uint32_t v) { return welded.vertices[v]; };
  std::vector<Triangle> added;
  std::size_t visits = 0;
  for (const BoundaryLoop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t u = loop[i], v = loop[(i + 1) % loop.size()];
      const Vec3 along = at(v) - at(u);
      if (norm(along) <= 2 * width) continue;  // all that is near is at its ends
      std::vector<std::pair<double, std::uint32_t>> between;
      visit_where(
          tree, Mesh{}, [&](const Aabb& box) { return may_pass(at(u), at(v), box, 2 * width); },
          [&](std::uint32_t k) {
            const std::uint32_t x = vertices[k];
            ++visits;
            const bool at_end = distance(at(x), at(u)) <= width || distance(at(x), at(v)) <= width;
            if (!at_end && distance_to_segment(at(x), at(u), at(v)) <= width) between.emplace_back(dot(at(x) - at(u), along), x);
            return visits <= kMostVisits * vertices.size();
          },
          budget);
      spend(budget, kVertexWork * between.size());
      std::sort(between.begin(), between.end());
      std::uint32_t last = u;
      for (const auto& [share, x] : between) {
        added.push_back({v, last, x});
        last = x;
      }
      if (added.size() > kMostSplits * vertices.size() || visits > kMostVisits * vertices.size()) return;
    }
  }
  welded.triangles.insert(welded.triangles.end(), added.begin(), added.end());
}

// For each vertex of the loops: the first vertex along the widest axis within the width, if not itself within the width
// of one before; the vertex itself where there is no other.
std::map<std::uint32_t, std::uint32_t> same_points(const Mesh& mesh, const std::vector<BoundaryLoop>& loops, double width,
                                                   Budget* budget) {
  std::vector<std::uint32_t> vertices = vertices_of(loops);
  const auto at = [&](std::uint32_t v) { return mesh.vertices[v]; };
  const int axis = widest_axis(mesh, vertices);
  const auto place = [&](std::uint32_t v) { return at(v)[axis]; };
  std::sort(vertices.begin(), vertices.end(), [&](auto u, auto v) { return place(u) != place(v) ? place(u) < place(v) : u < v; });
  const Bvh tree = tree_of(mesh, vertices);
  const Vec3 reach = Vec3{1, 1, 1} * (2 * width);  // beyond the width by more than all rounding
  std::map<std::uint32_t, std::uint32_t> same;
  for (const std::uint32_t first : vertices) {
    if (!same.try_emplace(first, first).second) continue;
    visit_box(tree, Mesh{}, {at(first) - reach, at(first) + reach}, [&](std::uint32_t k) {
      spend(budget, kVertexWork);
      if (distance(at(first), at(vertices[k])) <= width) same.try_emplace(vertices[k], first);
      return true;
    }, budget);
  }
  return same;
}

// Joins each boundary edge whose two ends have such partners to the edge between the partners.
void close_seams(Mesh& welded, const std::vector<BoundaryLoop>& loops, double width, Budget* budget) {
  const auto same = same_points(welded, loops, width, budget);
  const auto append = [&](const Triangle& t) {
    if (!repeats_a_corner(t)) welded.triangles.push_back(t);
  };
  for (const BoundaryLoop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t u = loop[i], v = loop[(i + 1) % loop.size()];
      const std::uint32_t p = same.at(u), q = same.at(v);
      append({v, u, p});
      append({v, p, q});
    }
  }
}

std::size_t close_thin_loops(Mesh& welded, const std::vector<BoundaryLoop>& loops, double width, Budget* budget) {
  std::size_t closed = 0;
  for (const BoundaryLoop& loop : loops) {
    spend(budget, kVertexWork * loop.size());
    if (!bounds_no_area(welded, loop, width)) continue;
    const std::vector<Triangle> triangles = fan(loop);
    welded.triangles.insert(welded.triangles.end(), triangles.begin(), triangles.end());
    ++closed;
  }
  return closed;
}

}  // namespace

std::size_t seal_cracks(Mesh& welded, double width, Budget* budget) {
  if (!(width < kThinBeside * norm(bounds_of(welded.vertices).size()))) return 0;
  const std::vector<BoundaryLoop> loops = boundary_loops(welded);
  if (loops.empty()) return 0;
  Mesh sealed = welded;
  split_edges(sealed, loops, width, budget);
  close_seams(sealed, boundary_loops(sealed), width, budget);
  const std::vector<BoundaryLoop> left = boundary_loops(sealed);
  close_thin_loops(sealed, left, width, budget);
  const std::size_t open = boundary_loops(sealed).size();
  if (open >= loops.size()) return 0;
  welded = std::move(sealed);
  return loops.size() - open;
}

}  // namespace satcheck
