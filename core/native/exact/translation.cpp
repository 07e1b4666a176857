#include "exact/translation.hpp"

#include "base/rounding.hpp"
#include "exact/double_double.hpp"
#include "exact/dyadic.hpp"

namespace satcheck {

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
