// Where a surface ends: its boundary, taken apart into simple loops.
//
// A directed edge belongs to the boundary as often as triangles run it more often than its reverse. So
// besides the rim of a hole it holds what a surplus copy of a triangle or one with the wrong winding
// leaves open. At every vertex as many boundary edges start as end, so the boundary is a set of loops.
#pragma once

#include <optional>
#include <vector>

#include "base/edge_table.hpp"
#include "base/mesh.hpp"

namespace satcheck {

// Vertices in the direction of the surface; none comes twice. The last one leads back to the first.
using BoundaryLoop = std::vector<std::uint32_t>;

// In an order that depends on nothing but the order of vertices and triangles.
std::vector<BoundaryLoop> boundary_loops(const Mesh& welded, const EdgeTable& edges);

// Triangles that close the loop: a fan about its first vertex, against the direction of the loop.
std::vector<Triangle> fan(const BoundaryLoop& loop);

// Loops that share a vertex can be taken apart in several ways, and be filled together, so they are one hole.
struct Hole {
  std::vector<BoundaryLoop> loops;
  Aabb box;

  double diameter() const { return norm(box.max - box.min); }
  Vec3 centre() const { return (box.min + box.max) * 0.5; }
};

// Turns each part of the mesh that is open and lies in one plane into a sheet: its triangles come in both windings
// then. In the plane no other fill of its boundary exists. Parts are connected through vertices.
void double_flat_parts(Mesh& welded);

// Of the mesh but for its flat parts; the largest first.
std::vector<Hole> find_holes(const Mesh& welded);

}  // namespace satcheck
