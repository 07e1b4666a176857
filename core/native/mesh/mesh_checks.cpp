#include "mesh/mesh_checks.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
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

bool is_flat(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  const auto corner = [&](std::uint32_t t, int k) { return mesh.vertices[mesh.triangles[t][k]]; };
  const auto wide = std::find_if(triangles.begin(), triangles.end(), [&](std::uint32_t t) {
    return !collinear(corner(t, 0), corner(t, 1), corner(t, 2));
  });
  if (wide == triangles.end()) return true;
  const Vec3 p = corner(*wide, 0), q = corner(*wide, 1), r = corner(*wide, 2);
  return std::all_of(triangles.begin(), triangles.end(), [&](std::uint32_t t) {
    for (int k = 0; k < 3; ++k) {
      if (orientation(p, q, r, corner(t, k)) != 0) return false;
    }
    return true;
  });
}

bool is_flat(const Mesh& mesh) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return is_flat(mesh, all);
}

FarVertex far_vertex(const Mesh& mesh) {
  if (mesh.vertices.empty()) return {};
  std::vector<double> largest;
  largest.reserve(mesh.vertices.size());
  for (const Vec3& p : mesh.vertices) largest.push_back(max_abs(p));
  const auto far = std::max_element(largest.begin(), largest.end()) - largest.begin();
  const auto middle = largest.begin() + static_cast<std::ptrdiff_t>(largest.size() / 2);
  std::nth_element(largest.begin(), middle, largest.end());
  return {mesh.vertices[static_cast<std::size_t>(far)], *middle};
}

}  // namespace satcheck
