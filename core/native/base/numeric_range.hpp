// The coordinates that the core works with, checked wherever coordinates enter it.
//
// Largest: the float64 stages multiply up to six coordinate differences, and (2e45)^6 is finite.
// Smallest size: likewise (1e-45)^6 is no subnormal. Smallest non-zero coordinate: two different
// doubles of at least 1e-80 differ by a multiple of 1e-97, so that the terms of an exact product of three
// differences are multiples of 1e-291, which float64 holds.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

inline constexpr double kLargestCoordinate = 1e45;
inline constexpr double kSmallestCoordinate = 1e-80;
inline constexpr double kSmallestSize = 1e-45;

inline bool in_range(double coordinate) {
  const double size = std::fabs(coordinate);
  return (size == 0) | ((size >= kSmallestCoordinate) & (size <= kLargestCoordinate));  // without a jump
}

// Whether require_in_range() accepts points that were computed, not given.
inline bool are_in_range(const std::vector<Vec3>& points) {
  Aabb box;
  bool all = true;
  for (const Vec3& p : points) {
    all &= in_range(p.x) & in_range(p.y) & in_range(p.z);
    box.include(p);
  }
  const double size = points.empty() ? 0 : max_abs(box.max - box.min);
  return all && (size == 0 || size >= kSmallestSize);
}

// Names the first offender: std::invalid_argument where it is not finite, std::overflow_error where it, or
// the whole, is out of range.
inline void require_in_range(const std::vector<Vec3>& points, const char* what) {
  if (are_in_range(points)) return;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i];
    if (in_range(p.x) && in_range(p.y) && in_range(p.z)) continue;
    const std::string where = std::string(what) + " " + std::to_string(i);
    if (!is_finite(p)) throw std::invalid_argument(where + " is not finite");
    throw std::overflow_error(where + " is out of range: coordinates other than 0 lie between 1e-80 and 1e45");
  }
  throw std::overflow_error("the size is out of range: it is below 1e-45");
}

}  // namespace satcheck
