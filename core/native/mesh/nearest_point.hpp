// The point of a surface nearest to a given one, by branch and bound over its box tree, in float64.
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

struct NearestPoint {
  double distance;
  Vec3 point;
  std::uint32_t triangle;
};

// The point of the surface nearest to p. Throws std::invalid_argument on an empty surface.
NearestPoint nearest_point(const Surface& surface, Vec3 p, Budget* budget = nullptr);

}  // namespace satcheck
