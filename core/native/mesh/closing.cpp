#include "convex/convex_hull.hpp"
#include "mesh/closing.hpp"

#include <cstdint>
#include <utility>

#include "base/edge_table.hpp"
#include "base/patches.hpp"

namespace satcheck {
namespace {

// Measured steps for each point of a rim.
constexpr std::uint64_t kHullWork = 100;

Closing fill_holes(const Surface& open) {
  Closing closing;
  Mesh closed = open.mesh;
  double_triangles(closed, open.sheets);
  closing.holes = find_holes(closed);
  for (const Hole& hole : closing.holes) {
    for (const BoundaryLoop& loop : hole.loops) {
      const std::vector<Triangle> triangles = fan(loop);
      closed.triangles.insert(closed.triangles.end(), triangles.begin(), triangles.end());
    }
  }
  closing.surface = std::make_shared<const Surface>(make_surface(closed, true));
  closing.hulls = hulls_of(open.mesh, closing.holes);
  return closing;
}

// A triangle and its reverse cancel in winding numbers, so the open parts become sheets. Closed patches within an
// edge-connected part stay solid.
Closing double_open_parts(const Mesh& welded) {
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  const Labels parts = label_components(welded, edges), patches = label_manifold_patches(welded, edges);
  const std::vector<bool> open_part = find_open_sets(parts, edges), open_patch = find_open_sets(patches, edges);
  std::vector<std::uint32_t> sheets;
  for (std::uint32_t t = 0; t < welded.triangles.size(); ++t) {
    if (open_part[parts.of_triangle[t]] && open_patch[patches.of_triangle[t]]) sheets.push_back(t);
  }
  Mesh closed = welded;
  double_triangles(closed, sheets);
  return {std::make_shared<const Surface>(make_surface(closed, true)), {}, {}};
}

}  // namespace

std::vector<Surface> hulls_of(const Mesh& mesh, const std::vector<Hole>& holes, Budget* budget) {
  std::vector<Surface> hulls;
  for (const Hole& hole : holes) {
    std::vector<Vec3> points;
    for (const BoundaryLoop& loop : hole.loops) {
      for (const std::uint32_t v : loop) points.push_back(mesh.vertices[v]);
    }
    spend(budget, kHullWork * points.size());
    Polytope hull = convex_hull(points, budget);
    hulls.push_back(make_surface(Mesh{std::move(hull.vertices), std::move(hull.triangles)}, true));
  }
  return hulls;
}

Closing close_surface(const Surface& open, OpenParts parts) {
  return parts == OpenParts::filled ? fill_holes(open) : double_open_parts(open.mesh);
}

}  // namespace satcheck
