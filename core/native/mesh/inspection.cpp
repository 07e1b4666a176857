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

Inspection sealed(Inspection given, double width, Budget& budget) {
  given.cracks = seal_cracks(given.mesh, width, &budget);
  if (given.cracks != 0) given.repaired = measure_topology(given.mesh);
  return given;
}

void orient_mesh(Inspection& result, const Poll& poll) {
  Budget budget = Budget::that_stops(kMostSteps, poll);
  Mesh oriented = orient(result.mesh, &budget);
  if (oriented.triangles == result.mesh.triangles && oriented.vertices == result.mesh.vertices) return;
  result.mesh = std::move(oriented);
  result.turned = true;
  result.repaired = measure_topology(result.mesh);
}

}  // namespace

// The winding of a mesh with a boundary is judged with its cracks closed, because edges beside a T-junction may have two
// triangles that belong to different neighbours.
Inspection inspect(MeshView mesh, bool orient_it, const Poll& poll) {
  Inspection result;
  result.mesh = weld_and_sort(mesh);
  result.topology = result.repaired = measure_sorted(result.mesh);
  if (result.topology.is_plain_solid()) return result;
  if (orient_it && result.topology.closed) orient_mesh(result, poll);
  if (has_boundary(result.repaired)) result.holes = holes_but_flat_parts(result.mesh);
  return result;
}

Inspection with_cracks_closed(Inspection given, bool orient_it, double width, const Poll& poll) {
  if (!has_boundary(given.repaired)) return given;
  Budget budget = Budget::that_stops(kMostSteps, poll);
  Inspection result = sealed(given, width, budget);
  if (orient_it && !result.repaired.oriented) {
    orient_mesh(given, poll);
    result = sealed(std::move(given), width, budget);
  }
  if (orient_it) orient_mesh(result, poll);
  result.holes = has_boundary(result.repaired) ? holes_but_flat_parts(result.mesh) : std::vector<Hole>{};
  return result;
}

}  // namespace satcheck
