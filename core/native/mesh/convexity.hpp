// The deviation of a closed mesh from its convex hull.
#pragma once

#include "base/budget.hpp"
#include "base/mesh.hpp"

namespace satcheck {

// An upper bound, rounding included, of the distance from any point of the convex hull to the solid: the error of using
// the hull instead of the solid. 0.0 only if the solid equals its hull, by exact signs. Infinite if the bound exceeds
// `limit`, and for meshes that are not solids.
double convexity_defect(const Mesh& mesh, double limit, Budget* budget = nullptr);

}  // namespace satcheck
