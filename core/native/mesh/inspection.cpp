#include "mesh/inspection.hpp"

#include <utility>

namespace satcheck {
namespace {

// One shell, wound outward: orient() would leave it as it is.
bool is_plain_solid(const Topology& topology) {
  return topology.closed && topology.manifold && topology.oriented && topology.components == 1 &&
         topology.volume > 0;
}

}  // namespace

Inspection inspect(const Mesh& mesh, bool orient_it) {
  Inspection found;
  found.mesh = weld_and_sort(mesh);
  found.turned = false;
  found.topology = measure_welded(found.mesh, EdgeTable(found.mesh.vertices.size(), found.mesh.triangles));
  found.repaired = found.topology;
  if (!orient_it || !found.topology.closed || is_plain_solid(found.topology)) return found;
  Mesh oriented = orient(found.mesh);
  if (oriented.triangles == found.mesh.triangles && oriented.vertices == found.mesh.vertices) return found;
  found.mesh = std::move(oriented);
  found.turned = true;
  found.repaired = measure_topology(found.mesh);
  return found;
}

}  // namespace satcheck
