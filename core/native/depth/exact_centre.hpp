// Where to put the origin for two meshes that lie far from it.
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

// A point that can be subtracted from every coordinate of both without rounding; 0 along an axis where the meshes are
// no farther from the origin than some times their size. About it coordinates are as short as they can be: a moved
// one is rounded less, and far fewer signs need exact arithmetic.
Vec3 exact_centre(const Surface& a, const Surface& b);

}  // namespace satcheck
