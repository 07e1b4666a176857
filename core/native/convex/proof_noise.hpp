// The rounding that a proof in float64 has to beat.
#pragma once

#include "base/tolerances.hpp"
#include "convex/shape.hpp"

namespace satcheck {

// How far the rounding of a pose moves a vertex at most, and that of the pair's relative pose its origin. A term
// of a turned coordinate is rounded 3 times, and the terms make no more than the reach, sqrt(3) times the largest
// coordinate: as a vector, 9 of that. The vertex is turned in one piece, its origin once more; adding the
// translation rounds the sum. Rounded up.
inline double placement_error(const Shape& shape, const Pose& pose) {
  if (pose.rotation == Mat3{} && pose.translation == Vec3{}) return 0;
  return kUnitRoundoff * (norm(pose.translation) + 20 * (max_abs(shape.origin) + shape.extent));
}

// How far the origin of a hull may come from where the quaternion puts it: 36 for the matrix (kCurvedSupportError)
// times sqrt(3), and the 9 of above; rounded up.
inline double origin_error(const Shape& shape, const Pose& pose) {
  return pose.rotation == Mat3{} ? 0 : 72 * kUnitRoundoff * max_abs(shape.origin);
}

// Lengths whose squares underflow are off by less than this. Only points that close to each other notice.
inline constexpr double kSquaresUnderflow = 1e-150;

// Of cores that are vertices, which are judged where their poses round them to. `scale` is that of A - B.
inline double proof_noise(double scale, const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  return kSupportError * scale + placement_error(a, pose_a) + placement_error(b, pose_b) + kSquaresUnderflow;
}

}  // namespace satcheck
