#include "mesh/transform.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/angle.hpp"
#include "base/numeric_range.hpp"
#include "base/rounding.hpp"
#include "exact/double_double.hpp"
#include "exact/dyadic.hpp"
#include "exact/predicates.hpp"

namespace satcheck {

Mesh transform(Mesh mesh, const Matrix& m) {
  for (const double entry : m) {
    if (!std::isfinite(entry)) throw std::overflow_error("the matrix is not finite");
  }
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
    throw std::invalid_argument("the matrix is not affine: its last row must be 0 0 0 1");
  }
  const Vec3 row[3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
  const int handedness = determinant_sign({}, row[0], {}, row[1], {}, row[2]);
  if (handedness == 0) throw std::invalid_argument("the matrix is singular");
  round_affine(row, {m[3], m[7], m[11]}, mesh.vertices);
  require_in_range(mesh.vertices, "transformed vertex");
  if (handedness < 0) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

Aabb placed_bounds(const Mesh& mesh, const Matrix& m) {
  return bounds_of(transform({mesh.vertices, {}}, m).vertices);
}

Mesh translate(const Mesh& mesh, Vec3 offset) {
  Mesh result{mesh.vertices, mesh.triangles};
  for (Vec3& p : result.vertices) p = p + offset;
  require_in_range(result.vertices, "transformed vertex");
  return result;
}

double largest_stretch(const Matrix& m) {
  double largest = 0;
  for (const std::size_t k : {0, 1, 2, 4, 5, 6, 8, 9, 10}) largest = std::max(largest, std::fabs(m[k]));
  if (largest == 0) return 0;
  const int exponent = std::ilogb(largest);
  const auto entry = [&](std::size_t k) { return std::scalbn(m[k], -exponent); };  // its fourth power is finite
  const double a = entry(0), b = entry(1), c = entry(2), d = entry(4), e = entry(5), f = entry(6), g = entry(8),
               h = entry(9), i = entry(10);
  double xx = a * a + d * d + g * g, yy = b * b + e * e + h * h, zz = c * c + f * f + i * i;
  double xy = a * b + d * e + g * h, xz = a * c + d * f + g * i, yz = b * c + e * f + h * i;
  const double mean = (xx + yy + zz) / 3;
  const double spread = (xx - mean) * (xx - mean) + (yy - mean) * (yy - mean) + (zz - mean) * (zz - mean);
  const double radius = std::sqrt((spread + 2 * (xy * xy + xz * xz + yz * yz)) / 6);
  if (radius == 0) return std::scalbn(std::sqrt(mean), exponent);
  xx = (xx - mean) / radius, yy = (yy - mean) / radius, zz = (zz - mean) / radius;
  xy /= radius, xz /= radius, yz /= radius;
  const double determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  const double half = std::clamp(determinant / 2, -1.0, 1.0);
  const double stretch = std::scalbn(std::sqrt(mean + 2 * radius * cosine_of(angle_of_cosine(half) / 3)), exponent);
  if (!std::isfinite(stretch)) throw std::overflow_error("the placement stretches lengths out of range");
  return stretch;
}

double largest_placed(const Matrix& m, double largest) {
  double result = 0;
  for (const std::size_t row : {0, 4, 8}) {
    const double sum = std::fabs(m[row]) + std::fabs(m[row + 1]) + std::fabs(m[row + 2]);
    result = std::max(result, sum * largest + std::fabs(m[row + 3]));
  }
  return result;
}

bool moves_within(std::span<const Vec3> points, Vec3 move, double length) {
  double rounded = 0;
  for (const Vec3& p : points) {
    for (int axis = 0; axis < 3; ++axis) rounded = larger(rounded, std::fabs(exact_sum(p[axis], move[axis]).low));
  }
  // Eight roundings at most in each term, and sqrt(3) for the vector of what three coordinates round.
  if (rounded > 0) return (scaled_norm(move) + 1.75 * rounded) * (1 + 8 * kUnitRoundoff) <= length;
  const auto square = [](double c) { return Dyadic(c) * Dyadic(c); };
  return (square(move.x) + square(move.y) + square(move.z) - square(length)).sign() <= 0;
}

}  // namespace satcheck
