#include "ladder/world_box.hpp"

#include <cmath>

#include "base/rounding.hpp"

namespace satcheck {

double box_gap(const Aabb& a, const Aabb& b) {
  const auto along = [&](int axis) {
    return std::fmax(std::fmax(b.min[axis] - a.max[axis], a.min[axis] - b.max[axis]), 0.0);
  };
  const Vec3 gap{along(0), along(1), along(2)};
  // The largest is rounded once, and so is its product with the factor below 1. The root has roundings of each
  // difference, 4 of the norm, and that of the product: less than 8.
  const double diagonal = scaled_norm(gap);
  return std::fmax(max_abs(gap) * (1 - kUnitRoundoff), diagonal * (1 - 8 * kUnitRoundoff));
}

}  // namespace satcheck
