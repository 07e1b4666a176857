// The point of a convex hull of a few vectors that is nearest to 0.
#pragma once

#include <vector>

#include "base/vec.hpp"

namespace satcheck {

// Of at least one. Each of them has at least the point's own length along the point, unless that is 0. Up to rounding;
// of flat tetrahedra and needles only the sides count, so that 0 may be missed.
Vec3 nearest_to_zero(const std::vector<Vec3>& of);

}  // namespace satcheck
