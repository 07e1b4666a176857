// Checks of a mesh before any geometry runs.
#pragma once

#include "base/mesh.hpp"

namespace satcheck {

// Throws std::invalid_argument on a coordinate (numeric_range.hpp) or an index out of range.
void require_valid(MeshView mesh);

// Whether all vertices lie in one plane, exactly. True if no triangle has an area.
bool is_flat(const Mesh& mesh);

// The same for some of its triangles.
bool is_flat(const Mesh& mesh, const std::vector<std::uint32_t>& triangles);

// The vertex with the largest |coordinate|, the first of equals, and the median of that of all vertices.
struct FarVertex {
  Vec3 at;
  double median = 0;
};
FarVertex far_vertex(const Mesh& mesh);

}  // namespace satcheck
