#include "mesh/inspection.hpp"

#include <utility>

#include "base/edge_table.hpp"
#include "mesh/cracks.hpp"
#include "mesh/orient.hpp"
#include "mesh/sorted_manifold.hpp"

namespace satcheck {
namespace {

Topology measure_sorted(const Mesh& sorted) {
  const auto plain = measure_sorted_manifold(sorted);
  return plain ? *plain : measure_welded(sorted, EdgeTable(sorted.vertices.size(), sorted.triangles));
}

bool has_boundary(const Topology& topology) { return !topology.closed || !topology.oriented; }

std::vector<Hole> holes_but_flat_parts(const Mesh& welded) {
  Mesh mesh = welded;
  double_triangles(mesh, flat_parts(welded));
  return find_holes(mesh);
}

void orient_mesh(Inspection& found) {
  Mesh oriented = orient(found.mesh);
  if (oriented.triangles == found.mesh.triangles && oriented.vertices == found.mesh.vertices) return;
  found.mesh = std::move(oriented);
  found.turned = true;
  found.repaired = measure_topology(found.mesh);
}

}  // namespace

Inspection inspect(MeshView mesh, bool orient_it) {
  Inspection found;
  found.mesh = weld_and_sort(mesh);
  found.topology = found.repaired = measure_sorted(found.mesh);
  if (found.topology.is_plain_solid()) return found;
  if (orient_it) orient_mesh(found);
  if (has_boundary(found.repaired)) found.holes = holes_but_flat_parts(found.mesh);
  return found;
}

Inspection with_cracks_closed(Inspection found, bool orient_it, double width) {
  if (!has_boundary(found.repaired)) return found;
  found.cracks = seal_cracks(found.mesh, width);
  if (found.cracks == 0) return found;
  found.repaired = measure_topology(found.mesh);
  if (orient_it) orient_mesh(found);
  found.holes = has_boundary(found.repaired) ? holes_but_flat_parts(found.mesh) : std::vector<Hole>{};
  return found;
}

}  // namespace satcheck
