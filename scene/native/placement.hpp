// Whether sixteen numbers place a body, where that is plain.
#pragma once

#include <array>
#include <cmath>

namespace satcheck::scene {

// All finite, affine, and so far from singular that no rounding of this sum matters; false: look closer.
inline bool surely_places(const std::array<double, 16>& m) {
  constexpr double kSurelyRegular = 0x1p-30;  // a thousand times what scene/format/placement.py calls singular
  for (const double entry : m) {
    if (!std::isfinite(entry)) return false;
  }
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) return false;
  const double one = std::hypot(m[0], m[1], m[2]), two = std::hypot(m[4], m[5], m[6]), three = std::hypot(m[8], m[9], m[10]);
  for (const double length : {one, two, three}) {  // so that no product leaves the range of numbers
    if (!(length > 1e-30 && length < 1e30)) return false;
  }
  const double determinant = m[0] * (m[5] * m[10] - m[9] * m[6]) - m[1] * (m[4] * m[10] - m[8] * m[6]) +
                             m[2] * (m[4] * m[9] - m[8] * m[5]);
  return std::fabs(determinant) > kSurelyRegular * (one * two * three);
}

}  // namespace satcheck::scene
