// A convex polytope inside the material of a solid mesh, grown about a seed.
#pragma once

#include <optional>
#include <vector>

#include "mesh/surface.hpp"

namespace satcheck {

// The convex hull of `vertices` has no point of the surface in its interior, and the winding number
// of its interior is not 0: proven, rounding included. Frame of the surface.
struct InnerRegion {
  std::vector<Vec3> vertices;  // extreme points, at least 4
  Aabb box;
};

// What counts as near while a region grows: x is as far from the seed as metric * (x - seed) is long.
using Metric = Mat3;

// Nothing where the seed is not strictly inside or so close to the surface that rounding decides.
std::optional<InnerRegion> grow_inner_region(const Surface& solid, Vec3 seed, const Metric& metric);

// The metric in which the region's vertices spread evenly.
Metric metric_of(const InnerRegion& region);

}  // namespace satcheck
