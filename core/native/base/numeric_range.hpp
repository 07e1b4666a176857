// The coordinates that the core works with, checked wherever coordinates enter it.
//
// Largest: the float64 stages multiply up to six coordinate differences, and (2e45)^6 is finite.
// Smallest size: likewise (1e-45)^6 is no subnormal. A single coordinate may be as small as float64 goes: no sign hangs
// on a product that underflows (exact/predicates.hpp).
#pragma once

#include <span>

#include "base/vec.hpp"

namespace satcheck {

inline constexpr double kLargestCoordinate = 1e45;
inline constexpr double kSmallestSize = 1e-45;

inline bool in_range(double coordinate) { return std::fabs(coordinate) <= kLargestCoordinate; }

// Whether require_in_range() accepts points that were computed, not given.
bool are_in_range(std::span<const Vec3> points);

// Names the first offender: std::invalid_argument where it is not finite, std::overflow_error where it, or
// the whole, is out of range.
void require_in_range(std::span<const Vec3> points, const char* what);

}  // namespace satcheck
