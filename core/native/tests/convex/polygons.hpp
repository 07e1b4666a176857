// Polygons for tests.
#pragma once

#include <cmath>

#include "convex/convex_polygon.hpp"

namespace satcheck::testing {

using Corners = std::vector<Vec2>;

inline Corners square(double x, double y, double size) {
  return {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
}

// Corners on a circle.
inline Corners ring(std::uint32_t count, double x, double y) {
  Corners corners;
  for (std::uint32_t k = 0; k < count; ++k) {
    const double angle = 2 * M_PI * k / count;
    corners.push_back({x + std::cos(angle), y + std::sin(angle)});
  }
  return corners;
}

inline ConvexPolygons pair_of(const Corners& a, const Corners& b) {
  Corners both = a;
  both.insert(both.end(), b.begin(), b.end());
  return {both, {0, static_cast<std::uint32_t>(a.size()), static_cast<std::uint32_t>(both.size())}};
}

}  // namespace satcheck::testing
