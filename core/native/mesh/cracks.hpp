// Cracks: places where neighbouring faces miss each other by the rounding of their file, and no more.
//
// T-junctions (a vertex of one face on the edge of another) and seams whose two copies of a vertex differ
// in the last digit. They leave a boundary that bounds no area. Triangles no wider than the crack close it;
// vertices and triangles of the mesh stay as they are.
#pragma once

#include <cstddef>

#include "base/mesh.hpp"

namespace satcheck {

// Appends to the welded mesh the triangles that close its cracks; returns how many loops of the boundary
// they close. width: points within it may be the same point.
std::size_t seal_cracks(Mesh& welded, double width);

}  // namespace satcheck
