#include "mesh/mesh_checks.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/numeric_range.hpp"
#include "exact/predicates.hpp"

namespace satcheck {

void require_valid(MeshView mesh) {
  // Half-edges are numbered 3 t + i in 32 bits.
  constexpr std::size_t kMaxTriangles = std::numeric_limits<std::uint32_t>::max() / 3 - 1;
  if (mesh.triangles.size() > kMaxTriangles) throw std::invalid_argument("too many triangles");
  require_in_range(mesh.vertices, "vertex");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v >= mesh.vertices.size()) {
        throw std::invalid_argument("triangle " + std::to_string(t) + " names vertex " +
                                    std::to_string(v) + " of " +
                                    std::to_string(mesh.vertices.size()));
      }
    }
  }
}

bool is_flat(const Mesh& mesh) {
  const auto corner = [&](const Triangle& t, int k) { return mesh.vertices[t[k]]; };
  const auto wide = std::find_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return !collinear(corner(t, 0), corner(t, 1), corner(t, 2));
  });
  return wide == mesh.triangles.end() || std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](Vec3 p) {
    return orientation(corner(*wide, 0), corner(*wide, 1), corner(*wide, 2), p) == 0;
  });
}

}  // namespace satcheck
