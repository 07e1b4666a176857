// How long a translation is, including the rounding of the moved coordinates.
#pragma once

#include <span>

#include "base/vec.hpp"

namespace satcheck {

// Whether `move`, added to these points with one rounding of each coordinate, takes none of them farther than `length`.
// Decided exactly where nothing is rounded.
bool moves_within(std::span<const Vec3> points, Vec3 move, double length);

}  // namespace satcheck
