#include "mesh/closing.hpp"

#include <utility>

#include "base/edge_table.hpp"
#include "base/patches.hpp"
#include "convex/polytope.hpp"

namespace satcheck {
namespace {

Closing fill_holes(const Mesh& welded) {
  Closing closing;
  closing.holes = find_holes(welded);
  Mesh closed = welded;
  double_flat_parts(closed);
  for (const Hole& hole : closing.holes) {
    for (const BoundaryLoop& loop : hole.loops) {
      const std::vector<Triangle> triangles = fan(loop);
      closed.triangles.insert(closed.triangles.end(), triangles.begin(), triangles.end());
    }
  }
  closing.surface = std::make_shared<const Surface>(make_surface(closed, true));
  closing.hulls = hulls_of(welded, closing.holes);
  return closing;
}

// Of the sets of triangles that the labels tell apart: does a set run an edge more often one way than the other?
std::vector<bool> are_open(const EdgeTable& edges, const Labels& labels) {
  std::vector<bool> open(labels.count, false);
  std::vector<std::pair<std::uint32_t, int>> balances;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    balances.clear();
    for (const std::uint32_t h : edges.half_edges(e)) {
      const std::uint32_t set = labels.of_triangle[h / 3];
      const int direction = edges.ascends(h) ? 1 : -1;
      auto of_set = balances.begin();
      while (of_set != balances.end() && of_set->first != set) ++of_set;
      if (of_set == balances.end()) {
        balances.emplace_back(set, direction);
      } else {
        of_set->second += direction;
      }
    }
    for (const auto& [set, balance] : balances) open[set] = open[set] || balance != 0;
  }
  return open;
}

// A triangle and its reverse have no winding number: the open parts become sheets. Of a part that is connected
// through edges, patches that are closed by themselves stay solid.
Closing double_open_parts(const Mesh& welded) {
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  const Labels parts = label_components(welded, edges), patches = label_manifold_patches(welded, edges);
  const std::vector<bool> open_part = are_open(edges, parts), open_patch = are_open(edges, patches);
  Mesh closed = welded;
  for (std::uint32_t t = 0; t < welded.triangles.size(); ++t) {
    const Triangle& v = welded.triangles[t];
    if (open_part[parts.of_triangle[t]] && open_patch[patches.of_triangle[t]]) closed.triangles.push_back({v[0], v[2], v[1]});
  }
  return {std::make_shared<const Surface>(make_surface(closed, true)), {}, {}};
}

}  // namespace

std::vector<Surface> hulls_of(const Mesh& mesh, const std::vector<Hole>& holes) {
  std::vector<Surface> hulls;
  for (const Hole& hole : holes) {
    std::vector<Vec3> points;
    for (const BoundaryLoop& loop : hole.loops) {
      for (const std::uint32_t v : loop) points.push_back(mesh.vertices[v]);
    }
    Polytope hull = convex_hull(points);
    hulls.push_back(make_surface(Mesh{std::move(hull.vertices), std::move(hull.triangles)}, true));
  }
  return hulls;
}

Closing close_surface(const Mesh& welded, OpenParts open) {
  return open == OpenParts::filled ? fill_holes(welded) : double_open_parts(welded);
}

}  // namespace satcheck
