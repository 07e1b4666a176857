// World boxes of placed meshes, without the placed meshes.
#pragma once

#include <array>
#include <optional>

#include "base/mesh.hpp"

namespace satcheck {

// The box around the vertices of transform(mesh, matrix), equal to the bit; empty if transform() throws.
std::optional<Aabb> placed_bounds(const Mesh& mesh, const std::array<double, 16>& matrix);

}  // namespace satcheck
