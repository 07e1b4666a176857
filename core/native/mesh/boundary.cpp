#include "mesh/boundary.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "base/edge_table.hpp"
#include "base/patches.hpp"
#include "convex/convex_hull.hpp"
#include "mesh/chains.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/facing.hpp"

namespace satcheck {
namespace {

}  // namespace

std::vector<BoundaryLoop> boundary_loops(const Mesh& welded) {
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  std::vector<NodePair> boundary;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const int balance = edges.balance(e);
    const std::uint32_t h = edges.half_edges(e)[0];
    const Triangle& t = welded.triangles[h / 3];
    const auto [low, high] = std::minmax(t[h % 3], t[(h % 3 + 1) % 3]);
    boundary.insert(boundary.end(), std::abs(balance), balance > 0 ? NodePair{low, high} : NodePair{high, low});
  }
  return join_loops(std::move(boundary));
}

std::vector<Triangle> fan(const BoundaryLoop& loop) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) triangles.push_back({loop[0], loop[i + 1], loop[i]});
  return triangles;
}

namespace {

std::vector<Hole> make_holes(const Mesh& mesh, const std::vector<BoundaryLoop>& loops) {
  std::map<std::uint32_t, std::uint32_t> first_at;  // a vertex: the first loop there
  DisjointSets sets(loops.size());
  for (std::uint32_t i = 0; i < loops.size(); ++i) {
    for (const std::uint32_t v : loops[i]) sets.unite(first_at.try_emplace(v, i).first->second, i);
  }
  std::vector<Hole> holes;
  std::vector<std::uint32_t> hole_of(loops.size(), kNoIndex);
  for (std::uint32_t i = 0; i < loops.size(); ++i) {
    const std::uint32_t set = sets.find(i);
    if (hole_of[set] == kNoIndex) {
      hole_of[set] = static_cast<std::uint32_t>(holes.size());
      holes.emplace_back();
    }
    Hole& hole = holes[hole_of[set]];
    hole.loops.push_back(loops[i]);
    for (const std::uint32_t v : loops[i]) hole.box.include(mesh.vertices[v]);
  }
  return holes;
}

Hole doubtful_hole(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  Hole hole;
  std::set<std::uint32_t> vertices;
  for (const std::uint32_t t : triangles) vertices.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
  hole.shell.assign(vertices.begin(), vertices.end());
  for (const std::uint32_t v : hole.shell) hole.box.include(mesh.vertices[v]);
  return hole;
}

void sort_by_size(std::vector<Hole>& holes) {
  const auto key = [](const Hole& h) {
    const Vec3 c = h.centre();
    return std::tuple(-h.diameter(), c.x, c.y, c.z);
  };
  std::stable_sort(holes.begin(), holes.end(), [&](const Hole& g, const Hole& h) { return key(g) < key(h); });
}

std::vector<Hole> holes_at(const Mesh& mesh, const std::vector<BoundaryLoop>& loops,
                           const std::vector<std::vector<std::uint32_t>>& doubtful) {
  std::vector<Hole> holes = make_holes(mesh, loops);
  for (const auto& triangles : doubtful) holes.push_back(doubtful_hole(mesh, triangles));
  sort_by_size(holes);
  return holes;
}

}  // namespace

std::vector<std::uint32_t> Hole::vertices() const {
  std::vector<std::uint32_t> all = shell;
  for (const BoundaryLoop& loop : loops) all.insert(all.end(), loop.begin(), loop.end());
  return all;
}

std::vector<std::uint32_t> flat_parts(const Mesh& welded) {
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  const Labels parts = label_vertex_components(welded);
  const std::vector<bool> open = find_open_sets(parts, edges);
  std::vector<std::uint32_t> flat;
  std::uint32_t number = 0;
  for (const auto& triangles : parts.members()) {
    if (open[number++] && is_flat(welded, triangles)) flat.insert(flat.end(), triangles.begin(), triangles.end());
  }
  return flat;
}

std::vector<std::uint32_t> open_parts(const Mesh& welded) {
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  const Labels patches = label_manifold_patches(welded, edges);
  const std::vector<bool> is_flap = find_flaps(patches, edges);
  std::vector<bool> is_open(welded.triangles.size(), false);
  for (const std::uint32_t t : flat_parts(welded)) is_open[t] = true;
  std::vector<std::uint32_t> open;
  for (std::uint32_t t = 0; t < is_open.size(); ++t) {
    if (is_open[t] || is_flap[patches.of_triangle[t]]) open.push_back(t);
  }
  return open;
}

void double_triangles(Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  for (const std::uint32_t t : triangles) {
    const Triangle v = mesh.triangles[t];
    mesh.triangles.push_back({v[0], v[2], v[1]});
  }
}

std::vector<Hole> find_holes(const Mesh& welded, const std::vector<std::vector<std::uint32_t>>& doubtful) {
  return holes_at(welded, boundary_loops(welded), doubtful);
}

namespace {

// Measured steps for each point of a rim.
constexpr std::uint64_t kHullWork = 100;

// The surface of an open one and what closes it at its vertices.
std::shared_ptr<const Surface> closed_surface(Mesh closed, const Surface& open) {
  Surface surface = make_plain_surface(std::make_shared<const Mesh>(std::move(closed)));
  surface.parts = open.parts;
  return std::make_shared<const Surface>(std::move(surface));
}

Closing fill_holes(const Surface& open, Budget* budget) {
  Closing closing;
  Mesh closed = open.mesh;
  double_triangles(closed, open.sheets);
  turn(closed, open.facing.inward);
  std::call_once(open.rims->has_loops, [&] { open.rims->loops = boundary_loops(closed); });
  closing.holes = holes_at(closed, open.rims->loops, open.facing.doubtful);
  for (const Hole& hole : closing.holes) {
    for (const BoundaryLoop& loop : hole.loops) {
      const std::vector<Triangle> triangles = fan(loop);
      closed.triangles.insert(closed.triangles.end(), triangles.begin(), triangles.end());
    }
  }
  closing.surface = closed_surface(std::move(closed), open);
  closing.hulls = hulls_of(open.mesh, closing.holes, budget);
  return closing;
}

// A triangle and its reverse cancel in winding numbers, so the open parts become sheets. Closed patches within an
// edge-connected part stay solid, unless they were turned beside a doubtful shell.
std::vector<std::uint32_t> loose_triangles(const Surface& open) {
  const Mesh& welded = open.mesh;
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  const Labels parts = label_components(welded, edges), patches = label_manifold_patches(welded, edges);
  const std::vector<bool> open_part = find_open_sets(parts, edges), open_patch = find_open_sets(patches, edges);
  std::vector<bool> is_sheet(welded.triangles.size());
  for (std::uint32_t t = 0; t < welded.triangles.size(); ++t) {
    is_sheet[t] = open_part[parts.of_triangle[t]] && open_patch[patches.of_triangle[t]];
  }
  for (const std::uint32_t t : open.facing.inward) is_sheet[t] = true;
  for (const auto& part : open.facing.doubtful) {
    for (const std::uint32_t t : part) is_sheet[t] = true;
  }
  std::vector<std::uint32_t> loose;
  for (std::uint32_t t = 0; t < welded.triangles.size(); ++t) {
    if (is_sheet[t]) loose.push_back(t);
  }
  return loose;
}

Closing double_open_parts(const Surface& open) {
  std::call_once(open.rims->has_loose, [&] { open.rims->loose = loose_triangles(open); });
  Mesh closed = open.mesh;
  double_triangles(closed, open.rims->loose);
  return {closed_surface(std::move(closed), open), {}, {}};
}

}  // namespace

std::vector<Surface> hulls_of(const Mesh& mesh, const std::vector<Hole>& holes, Budget* budget) {
  std::vector<Surface> hulls;
  for (const Hole& hole : holes) {
    std::vector<Vec3> points;
    for (const std::uint32_t v : hole.vertices()) points.push_back(mesh.vertices[v]);
    spend(budget, kHullWork * points.size());
    Polytope hull = convex_hull(points, budget);
    hulls.push_back(make_surface(Mesh{std::move(hull.vertices), std::move(hull.triangles)}, true));
  }
  return hulls;
}

Closing close_surface(const Surface& open, OpenParts parts, Budget* budget) {
  return parts == OpenParts::filled ? fill_holes(open, budget) : double_open_parts(open);
}

}  // namespace satcheck
