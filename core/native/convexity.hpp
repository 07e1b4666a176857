// How far a closed mesh is from being convex.
#pragma once

#include "mesh.hpp"

namespace satcheck {

// An upper bound, rounding included, of the largest distance of a point of the surface below its
// convex hull. 0.0 only if the solid equals its hull, by exact signs. Infinite as soon as the bound
// exceeds `limit`, and for meshes that are not solids or are hollow.
double convexity_defect(const Mesh& mesh, double limit);

}  // namespace satcheck
