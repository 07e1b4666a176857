// Whether a surface reaches deeper into a solid than a length.
#pragma once

#include <cstdint>
#include <optional>

#include "base/mesh.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

// Whether a point of the triangles of `surface_of` lies inside the solid, farther than `length` from all triangles of it,
// to rounding. Nothing where `work` steps (base/budget.hpp) do not decide that.
std::optional<bool> reaches_deeper(const Mesh& surface_of, const Surface& solid, double length, std::uint64_t work);

}  // namespace satcheck
