// Meshes in world coordinates. Only this function applies a placement to vertices.
#pragma once

#include <array>

#include "base/mesh.hpp"

namespace satcheck {

// world = matrix * (x, y, z, 1), row-major; each coordinate is summed in twice the precision and
// rounded once. A reflection flips the winding. Throws std::invalid_argument when the matrix is not
// finite, not affine or singular, or a coordinate overflows.
Mesh transform(const Mesh& mesh, const std::array<double, 16>& matrix);
Mesh translate(const Mesh& mesh, Vec3 offset);

}  // namespace satcheck
