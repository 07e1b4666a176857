// A mesh with what queries need of it, built once and shared between queries and threads.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/mesh.hpp"
#include "mesh/bvh.hpp"

namespace satcheck {

struct Surface {
  // welded: as it stays; others may hold it too.
  explicit Surface(std::shared_ptr<const Mesh> welded) : owned(std::move(welded)), mesh(*owned) {}

  std::shared_ptr<const Mesh> owned;
  const Mesh& mesh;
  Bvh bvh;
  std::vector<std::uint32_t> parts;  // a triangle of each part that is connected through common vertices
  // Closed and consistently wound: winding numbers say what is inside.
  bool solid = false;
  bool refitted = false;  // the tree has the form of another surface's
};

// Throws std::invalid_argument when `solid` is claimed of a surface that is not closed and
// consistently wound, for then it has no inside.
Surface make_surface(const Mesh& mesh, bool solid);

// The same of a mesh as inspect() left it, whose topology was that of a plain solid: nothing is proven again.
// region: where queries will be, as build_bvh_near() takes it; nothing: anywhere.
Surface make_plain_surface(std::shared_ptr<const Mesh> inspected, const Aabb* region = nullptr);

// The surface of `mesh`, which is that of `like` with its vertices elsewhere, as an affine map puts them;
// a mirror turns the winding. Nothing is sorted: the tree of `like` is fitted again. Where the triangles
// are others, or rounding has put two vertices into one place, the surface is made anew.
Surface refitted_surface(const Surface& like, Mesh mesh);

// Winding number of a point with respect to a solid; nothing when the point is on the surface.
std::optional<int> winding_number(const Surface& surface, Vec3 point);

inline std::array<Vec3, 3> corners(const Mesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

}  // namespace satcheck
