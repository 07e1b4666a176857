#include "mesh/mesh_checks.hpp"

#include <limits>
#include <stdexcept>
#include <string>

#include "base/numeric_range.hpp"

namespace satcheck {

void require_valid(const Mesh& mesh) {
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

}  // namespace satcheck
