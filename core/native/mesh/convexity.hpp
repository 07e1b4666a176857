// How far a closed mesh is from being convex.
#pragma once

#include "base/mesh.hpp"

namespace satcheck {

// An upper bound, rounding included, of the distance from any point of the convex hull to the solid:
// to take the hull for the solid is wrong by no more. 0.0 only if the solid equals its hull, by exact
// signs. Infinite as soon as the bound exceeds `limit`, and for meshes that are not solids.
double convexity_defect(const Mesh& mesh, double limit);

}  // namespace satcheck
