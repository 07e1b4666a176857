#include "ladder/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"

namespace satcheck {

double largest_stretch(const std::array<double, 16>& m) {
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

double largest_placed(const std::array<double, 16>& m, double largest) {
  double result = 0;
  for (const std::size_t row : {0, 4, 8}) {
    const double sum = std::fabs(m[row]) + std::fabs(m[row + 1]) + std::fabs(m[row + 2]);
    result = std::max(result, sum * largest + std::fabs(m[row + 3]));
  }
  return result;
}

}  // namespace satcheck
