// The length of a translation, including the rounding of the moved coordinates.
#pragma once

#include <span>

#include "base/vec.hpp"

namespace satcheck {

// Whether `move`, added to these points with one rounding of each coordinate, moves no point farther than `length`.
// Exact if nothing is rounded.
bool moves_within(std::span<const Vec3> points, Vec3 move, double length);

}  // namespace satcheck
