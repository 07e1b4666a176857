#include "mesh/inspection.hpp"

#include <utility>

#include "mesh/sorted_manifold.hpp"

namespace satcheck {
Inspection inspect(MeshView mesh, bool orient_it) {
  Inspection found;
  found.mesh = weld_and_sort(mesh);
  found.turned = false;
  const auto plain = measure_sorted_manifold(found.mesh);
  found.topology = plain ? *plain : measure_welded(found.mesh, EdgeTable(found.mesh.vertices.size(), found.mesh.triangles));
  found.repaired = found.topology;
  if (!orient_it || !found.topology.closed || found.topology.is_plain_solid()) return found;
  Mesh oriented = orient(found.mesh);
  if (oriented.triangles == found.mesh.triangles && oriented.vertices == found.mesh.vertices) return found;
  found.mesh = std::move(oriented);
  found.turned = true;
  found.repaired = measure_topology(found.mesh);
  return found;
}

}  // namespace satcheck
