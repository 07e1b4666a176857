// Where one body is in the frame of another, with a bound of all rounding.
#pragma once

#include <cmath>

#include "base/rounding.hpp"
#include "poses/posed_body.hpp"

namespace satcheck {

// A coordinate, a height or a width that is computed in the frame of A from coordinates of at most `size` is off by at
// most this times `size`: fewer than 64 roundings.
inline constexpr double kFrameRounding = 64 * kUnitRoundoff;
// An entry of a product of 3x3 matrices, compared with another matrix: 6 roundings of its terms, rounded up.
inline constexpr double kProductRounding = 8 * kUnitRoundoff;

inline Vec3 absolute(Vec3 v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }
inline Mat3 absolute(const Mat3& m) { return {{absolute(m.row[0]), absolute(m.row[1]), absolute(m.row[2])}}; }
inline double sum(Vec3 v) { return v.x + v.y + v.z; }

// Takes points of B into the frame of A.
struct Relative {
  Mat3 linear;
  Vec3 offset;
  double size = 0;   // bounds the sum of |terms| of the three coordinates of any vertex of A or B
  double slack = 0;  // bounds how far all rounding, that of the world included, moves a vertex of A towards one of B

  Vec3 operator*(Vec3 p) const { return linear * p + offset; }
};

// largest_a, largest_b: bound the |coordinates| of the vertices of A and B in their files.
Relative relative_place(const PosedPlace& at_a, Vec3 largest_a, const PosedPlace& at_b, Vec3 largest_b);

}  // namespace satcheck
