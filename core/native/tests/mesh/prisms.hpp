// Prisms for tests.
#pragma once

#include "mesh/surface.hpp"

namespace satcheck::testing {

// Over the square from (x, y), from -height + lift to height + lift.
inline Mesh square_mesh(double x, double y, double size, double height, double lift = 0) {
  Mesh mesh;
  for (const double z : {-height + lift, height + lift}) {
    for (const Vec2 p : {Vec2{x, y}, Vec2{x + size, y}, Vec2{x + size, y + size}, Vec2{x, y + size}}) mesh.vertices.push_back({p.x, p.y, z});
  }
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t n = (k + 1) % 4;
    mesh.triangles.push_back({k, n, n + 4});
    mesh.triangles.push_back({k, n + 4, k + 4});
  }
  return mesh;
}

inline Surface square_prism(double x, double y, double size, double height) {
  return make_surface(square_mesh(x, y, size, height), true);
}

}  // namespace satcheck::testing
