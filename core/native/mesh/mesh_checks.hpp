// What a mesh must satisfy before any geometry runs.
#pragma once

#include "base/mesh.hpp"

namespace satcheck {

// Throws std::invalid_argument on a coordinate (numeric_range.hpp) or an index out of range.
void require_valid(const Mesh& mesh);

}  // namespace satcheck
