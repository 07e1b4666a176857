// Coordinates are first computed in plain float64. Only those that could be the largest or the smallest, or could
// overflow, are computed exactly as in transform().
#include "mesh/transform.hpp"
#include "ladder/placed_bounds.hpp"

#include <stdexcept>

#include "base/numeric_range.hpp"
#include "base/rounding.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

struct Interval {
  double low = INFINITY, high = -INFINITY;

  void include(double c) {
    low = c < low ? c : low;
    high = c > high ? c : high;
  }
};

// The range of one world coordinate over all vertices; empty if one is out of range.
std::optional<Interval> along(const std::vector<Vec3>& vertices, Vec3 row, double offset, Vec3 largest) {
  // A bound of the difference between the plain sum, with 4 roundings of at most this size, and the compensated sum,
  // with 1.
  const double size = std::fabs(row.x) * largest.x + std::fabs(row.y) * largest.y + std::fabs(row.z) * largest.z +
                      std::fabs(offset);
  const double error = 8 * kUnitRoundoff * size;
  if (!(size <= 0.5 * kLargestCoordinate)) return std::nullopt;
  Interval plain, exact;
  const auto plain_sum = [&](Vec3 p) { return row.x * p.x + row.y * p.y + row.z * p.z + offset; };
  for (const Vec3& p : vertices) plain.include(plain_sum(p));
  for (const Vec3& p : vertices) {
    const double c = plain_sum(p);
    if (c > plain.low + 2 * error && c < plain.high - 2 * error) continue;
    const double rounded = rounded_affine(row, p, offset);
    if (!in_range(rounded)) return std::nullopt;
    exact.include(rounded);
  }
  return exact;
}

std::optional<Aabb> bounds_of(const std::vector<Vec3>& points) {
  if (points.empty()) return std::nullopt;
  Aabb box;
  for (const Vec3& p : points) box.include(p);
  return box;
}

// For sums near the ends of the range; speed does not matter there.
std::optional<Aabb> bounds_of_placed(const Mesh& mesh, const std::array<double, 16>& m) {
  try {
    return bounds_of(transform(Mesh{mesh.vertices, {}}, m).vertices);
  } catch (const std::logic_error&) {  // std::invalid_argument
    return std::nullopt;
  } catch (const std::overflow_error&) {
    return std::nullopt;
  }
}

bool is_proper(const std::array<double, 16>& m) {
  for (const double entry : m) {
    if (!std::isfinite(entry)) return false;
  }
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) return false;
  return determinant_sign({}, {m[0], m[1], m[2]}, {}, {m[4], m[5], m[6]}, {}, {m[8], m[9], m[10]}) != 0;
}

}  // namespace

std::optional<Aabb> placed_bounds(const Mesh& mesh, const std::array<double, 16>& m) {
  if (!is_proper(m) || mesh.vertices.empty()) return std::nullopt;
  Vec3 largest;
  for (const Vec3& p : mesh.vertices) {
    largest = {std::fmax(largest.x, std::fabs(p.x)), std::fmax(largest.y, std::fabs(p.y)),
               std::fmax(largest.z, std::fabs(p.z))};
  }
  const auto x = along(mesh.vertices, {m[0], m[1], m[2]}, m[3], largest);
  const auto y = along(mesh.vertices, {m[4], m[5], m[6]}, m[7], largest);
  const auto z = along(mesh.vertices, {m[8], m[9], m[10]}, m[11], largest);
  if (!x || !y || !z) return bounds_of_placed(mesh, m);
  const Aabb box{{x->low, y->low, z->low}, {x->high, y->high, z->high}};
  const double extent = max_abs(box.max - box.min);
  return extent == 0 || extent >= kSmallestSize ? std::optional(box) : std::nullopt;
}

}  // namespace satcheck
