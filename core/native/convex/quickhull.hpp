// The triangulated boundary of the convex hull of a full-dimensional point set.
#pragma once

#include <array>
#include <vector>

#include "base/budget.hpp"
#include "base/vec.hpp"

namespace satcheck {

// Outward, counter-clockwise triangles over distinct finite points. `simplex`: four points that are not coplanar. No
// point lies strictly above the plane of any triangle. Triangles may be
// exactly coplanar with their neighbours, and a corner may lie inside a flat part or on a straight
// edge, but no triangle is degenerate.
std::vector<Triangle> quickhull(const std::vector<Vec3>& points,
                                std::array<std::uint32_t, 4> simplex, Budget* budget = nullptr);

}  // namespace satcheck
