// Distances of surfaces and points, by branch and bound over box trees, in float64.
#pragma once

#include <optional>

#include "mesh_pair.hpp"
#include "surface.hpp"

namespace satcheck {

struct MeshDistance {
  double distance = INFINITY;  // |witness_b - witness_a|; infinite when beyond the limit
  Vec3 witness_a, witness_b;
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;
};

// Distance of the two surfaces, 0 when they meet; what is inside a solid makes no difference.
MeshDistance mesh_distance(const Surface& a, const Surface& b, double limit);

struct NearestPoint {
  double distance;
  Vec3 point;
  std::uint32_t triangle;
};

// The point of the surface nearest to p. Throws std::invalid_argument on an empty surface.
NearestPoint nearest_point(const Surface& surface, Vec3 p);

}  // namespace satcheck
