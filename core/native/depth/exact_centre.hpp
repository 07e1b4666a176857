// Where to put the origin for two meshes that lie far from it.
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

// A point near the meshes that can be subtracted from every coordinate of both without rounding; 0 along an axis where
// the meshes are near the origin anyway. Seen from it coordinates are short: moving them rounds less, and far fewer
// signs need exact arithmetic.
Vec3 exact_centre(const Surface& a, const Surface& b);

}  // namespace satcheck
