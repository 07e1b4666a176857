// Topology of a triangle soup: closed, manifold, consistently wound. Also welds and sorts vertices.
#pragma once

#include <vector>

#include "base/budget.hpp"
#include "base/edge_table.hpp"
#include "base/mesh.hpp"

namespace satcheck {

// Edges are counted on the welded mesh. Triangles that name a corner twice do not count.
struct Topology {
  std::size_t vertices = 0;   // of the mesh as given
  std::size_t triangles = 0;  // of the mesh as given
  std::size_t components = 0;           // parts connected through shared edges
  std::size_t boundary_edges = 0;       // one triangle
  std::size_t nonmanifold_edges = 0;    // more than two triangles
  std::size_t misoriented_edges = 0;    // not run equally often in both directions (open edges: once)
  std::size_t degenerate_triangles = 0; // corners exactly collinear or repeated
  std::size_t duplicate_triangles = 0;  // same corners as an earlier triangle, in either winding
  bool closed = false;    // every edge has an even number of triangles, and there is an edge
  bool manifold = false;  // every edge has exactly two
  bool oriented = false;  // no misoriented edge
  double volume = 0;      // signed, positive when wound outwards; 0.0 unless closed and oriented
  bool solid = false;     // closed, oriented, volume not exactly 0: winding numbers say what is inside

  // One shell, wound outward: orient() would leave it as it is.
  bool is_plain_solid() const { return closed && manifold && oriented && components == 1 && volume > 0; }
};

Topology measure_topology(const Mesh& mesh);

// The same of a welded mesh whose edges are known.
Topology measure_welded(const Mesh& welded, const EdgeTable& edges);

// Vertices of equal coordinates become one (-0.0 == 0.0), unreferenced ones are dropped; the order
// of vertices and triangles is kept.
Mesh weld(const Mesh& mesh);

// No two vertices have equal coordinates.
bool is_welded(const Mesh& mesh);

// The same triangles in an order that depends only on their coordinates: vertices ascending, each triangle starting at
// its lowest vertex, triangles ascending. Copies of a vertex are not merged.
Mesh sort(const Mesh& mesh);

// sort(weld(mesh)), but faster.
Mesh weld_and_sort(MeshView mesh);

// The parts connected through shared edges of the welded mesh, in order of their first triangle. Edges on
// the two sides of a crack of this width (mesh/cracks.hpp) count as shared. The wall of a cavity (mesh/cavities.hpp)
// belongs to the part around it. Throws BudgetSpent if finding cavities takes more than kMostSteps. poll: called now and
// then.
std::vector<Mesh> split_components(const Mesh& mesh, double crack_width = 0, const Poll& poll = {});

}  // namespace satcheck
