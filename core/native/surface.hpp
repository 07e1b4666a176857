// A mesh with its tree, built once and shared between queries and threads.
#pragma once

#include "bvh.hpp"
#include "mesh.hpp"

namespace satcheck {

struct Surface {
  Mesh mesh;
  Bvh bvh;
  // Closed and consistently wound, as told by its owner: winding numbers say what is inside.
  bool solid = false;
};

// Throws std::invalid_argument when `solid` is claimed of a surface that is not closed and
// consistently wound, for then it has no inside.
Surface make_surface(const Mesh& mesh, bool solid);

inline Vec3 corner(const Mesh& mesh, std::uint32_t triangle, int i) {
  return mesh.vertices[mesh.triangles[triangle][static_cast<std::size_t>(i)]];
}

}  // namespace satcheck
