// A triangle mesh: plain arrays, no topology and no cache.
#pragma once

#include <span>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

// A mesh in memory that the view does not own.
struct MeshView {
  std::span<const Vec3> vertices;
  std::span<const Triangle> triangles;

  MeshView(std::span<const Vec3> v, std::span<const Triangle> t) : vertices(v), triangles(t) {}
  MeshView(const Mesh& mesh) : MeshView(mesh.vertices, mesh.triangles) {}  // implicit: a mesh is accepted as a view
};

inline std::array<Vec3, 3> corners(const Mesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

}  // namespace satcheck
