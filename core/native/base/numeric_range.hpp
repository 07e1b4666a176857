// The range of coordinates of the core. It is checked wherever coordinates enter the core.
//
// Largest: the float64 stages multiply up to six coordinate differences, and (2e45)^6 is finite.
// Smallest size: likewise (1e-45)^6 is not subnormal. A single coordinate may have any small value, because no sign
// depends on a product that underflows (exact/predicates.hpp).
#pragma once

#include <span>

#include "base/vec.hpp"

namespace satcheck {

inline constexpr double kLargestCoordinate = 1e45;
inline constexpr double kSmallestSize = 1e-45;

inline bool in_range(double coordinate) { return std::fabs(coordinate) <= kLargestCoordinate; }

// Whether require_in_range() would accept these points.
bool are_in_range(std::span<const Vec3> points);

// Throws an error that names the first wrong coordinate: std::invalid_argument if it is not finite, std::overflow_error
// if it, or the size of all points, is out of range.
void require_in_range(std::span<const Vec3> points, const char* what);

}  // namespace satcheck
