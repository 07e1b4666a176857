// A convex polytope inside the material of a solid mesh, grown about a seed.
#pragma once

#include <optional>
#include <vector>

#include "convex/convex_hull.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

// The convex hull of `vertices` has no point of the surface in its interior, and the winding number there is not 0.
// Both are proven, rounding included. Frame of the surface.
struct InnerRegion {
  std::vector<Vec3> vertices;  // at least 4; up to rounding, all of them are extreme
  Aabb box;
  std::vector<Vec3> normals;  // each triangle of the surface is farther along one of them than all vertices are
};

// The metric for distances while a region grows: the distance of x from the seed is the length of metric * (x - seed).
using Metric = Mat3;

// Empty if the seed is not strictly inside, or too close to the surface to tell. within: a solid that the region does not
// leave, up to rounding; null: the box of the surface.
std::optional<InnerRegion> grow_inner_region(const Surface& solid, Vec3 seed, const Metric& metric, Budget* budget = nullptr,
                                             const Polytope* within = nullptr);

// The metric in which the covariance of the points is that of a ball.
Metric metric_of(const std::vector<Vec3>& points);

}  // namespace satcheck
