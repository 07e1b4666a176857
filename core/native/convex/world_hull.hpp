// The core of a placed shape for exact arithmetic.
#pragma once

#include "convex/shape.hpp"

namespace satcheck {

// The hull of the world vertices, each rounded by the pose. For polytopes, spheres (their centre) and capsules
// (their axis).
Polytope world_hull(const Shape& shape, const Pose& pose);

}  // namespace satcheck
