// The boundary of a surface, split into simple loops, and how it is closed, so that every point has a winding number.
//
// Triangles run an edge in two directions. The surplus of one direction belongs to the boundary.
// So the boundary includes the rims of holes, and the edges of a surplus copy of a triangle or of a triangle with
// the wrong winding. At every vertex as many boundary edges start as end, so the boundary is a set of loops.
//
// Two fills of a loop give the same winding numbers, except at points between them. If fills stay within the convex hull
// of their loop, all fills agree about inside and outside at all points outside of these hulls.
#pragma once

#include <memory>
#include <vector>

#include "base/mesh.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

// Vertices in the direction of the surface, each once. The last one is connected to the first.
using BoundaryLoop = std::vector<std::uint32_t>;

// Their order depends only on the order of vertices and triangles.
std::vector<BoundaryLoop> boundary_loops(const Mesh& welded);

// Triangles that close the loop: a fan about its first vertex, against the direction of the loop.
std::vector<Triangle> fan(const BoundaryLoop& loop);

// Loops that share a vertex are one hole, because they can be split in several ways, and one fill may close them all. A
// shell that may be solid or the wall of a cavity (mesh/facing.hpp) is a hole too: it has no loops.
struct Hole {
  std::vector<BoundaryLoop> loops;
  std::vector<std::uint32_t> shell;  // the vertices of such a shell
  Aabb box;

  std::vector<std::uint32_t> vertices() const;
  double diameter() const { return norm(box.max - box.min); }
  Vec3 centre() const { return (box.min + box.max) * 0.5; }
};

// The triangles of open parts that lie in one plane. They are sheets, because their boundary has no other fill in the
// plane. Parts are connected through vertices.
std::vector<std::uint32_t> flat_parts(const Mesh& welded);

// The triangles of flaps (base/patches.hpp) and of flat parts. They are sheets if open parts are intended.
std::vector<std::uint32_t> open_parts(const Mesh& welded);

// Turns these triangles into sheets by adding them in the opposite winding.
void double_triangles(Mesh& mesh, const std::vector<std::uint32_t>& triangles);

// The largest first. Flat parts are holes too, unless they are doubled. doubtful: the triangles of shells (mesh/facing.hpp).
std::vector<Hole> find_holes(const Mesh& welded, const std::vector<std::vector<std::uint32_t>>& doubtful = {});

struct Closing {
  // Closed: the triangles of the open surface first, then those that close it. Doubtful shells are cavities.
  std::shared_ptr<const Surface> surface;
  std::vector<Hole> holes;     // the largest first; none of sheets
  std::vector<Surface> hulls;  // closed, one for each hole: every fill of the hole lies within it
};

Closing close_surface(const Surface& open, OpenParts parts, Budget* budget = nullptr);

// The hulls of these holes of a mesh.
std::vector<Surface> hulls_of(const Mesh& mesh, const std::vector<Hole>& holes, Budget* budget = nullptr);

}  // namespace satcheck
