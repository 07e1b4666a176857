// Cracks: gaps between neighbouring faces that are no wider than the precision of their file.
//
// Cracks are T-junctions (a vertex of one face on the edge of another) and seams with two copies of a vertex that
// differ in the last digit. Their boundary bounds no area. Triangles no wider than the crack close it. Vertices and
// triangles of the mesh do not change.
#pragma once

#include <cstddef>

#include "base/budget.hpp"
#include "base/mesh.hpp"

namespace satcheck {

// Appends to the welded mesh the triangles that close its cracks; returns how many loops of the boundary
// they close. width: points within it may be the same point. Throws BudgetSpent.
std::size_t seal_cracks(Mesh& welded, double width, Budget* budget = nullptr);

}  // namespace satcheck
