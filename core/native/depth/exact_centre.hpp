// A new origin for two meshes that are far from the origin.
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

// A point near the meshes that can be subtracted from all their coordinates without rounding; 0 along an axis on which
// the meshes are near the origin. Relative to it, coordinates are small: moving them rounds less, and far fewer signs
// need exact arithmetic.
Vec3 exact_centre(const Surface& a, const Surface& b);

}  // namespace satcheck
