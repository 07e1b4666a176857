#include "mesh/winding.hpp"

#include <limits>
#include <numbers>

#include "base/angle.hpp"

namespace satcheck {
namespace {

// Additive recurrence in two dimensions: Martin Roberts, "The Unreasonable Effectiveness of
// Quasirandom Sequences" (2018): powers of 1 / the plastic number.
constexpr double kStep1 = 0.7548776662466927, kStep2 = 0.5698402909980532;

// Slopes increase with the attempts, from nearly axis-parallel (few boxes on the way) to steep.
constexpr double kFirstSlope = 1.0 / 64, kSlopeGrowth = 1.03;

double fraction(double x) { return x - std::floor(x); }

}  // namespace

Heading nearest_wall(const Aabb& box, Vec3 from) {
  Heading nearest;
  double least = INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    const double down = from[axis] - box.min[axis], up = box.max[axis] - from[axis];
    if (std::fmin(down, up) < least) {
      least = std::fmin(down, up);
      nearest = {axis, up <= down};
    }
  }
  return nearest;
}

Vec3 outside_point(const Aabb& box, Vec3 from, Heading first, int attempt) {
  const Vec3 extent = box.max - box.min;
  const double size = std::fmax(max_abs(extent), std::numeric_limits<double>::min());
  const int axis = (first.axis + attempt % 6 / 2) % 3;
  const bool upward = (attempt % 2 == 0) == first.upward;
  double slope = kFirstSlope;
  for (int k = 0; k < attempt; ++k) slope *= kSlopeGrowth;
  const double s = slope * (2 * fraction(0.5 + kStep1 * (attempt + 1)) - 1);
  const double t = slope * (2 * fraction(0.5 + kStep2 * (attempt + 1)) - 1);
  // Beyond the wall by half the size, so that `far` is outside the box in spite of rounding.
  const double wall = upward ? box.max[axis] + size / 2 : box.min[axis] - size / 2;
  const double reach = std::fabs(wall - from[axis]);
  switch (axis) {
    case 0: return {wall, from.y + s * reach, from.z + t * reach};
    case 1: return {from.x + t * reach, wall, from.z + s * reach};
    default: return {from.x + s * reach, from.y + t * reach, wall};
  }
}

double generalized_winding_number(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, Vec3 point) {
  double sum = 0;
  for (const std::uint32_t number : triangles) {
    const Triangle& t = mesh.triangles[number];
    const Vec3 a = mesh.vertices[t[0]] - point, b = mesh.vertices[t[1]] - point, c = mesh.vertices[t[2]] - point;
    const double x = norm(a), y = norm(b), z = norm(c);
    sum += direction_angle(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace satcheck
