// The rounding error that a proof in float64 has to exceed.
#pragma once

#include "base/rounding.hpp"
#include "convex/shape.hpp"

namespace satcheck {

// The largest distance that the rounding of a pose moves a vertex, plus the largest distance that the rounding of the
// pair's relative pose moves its origin. Each term of a rotated coordinate is rounded 3 times, and the terms sum up to
// the reach at most, which is sqrt(3) times the largest coordinate. As a vector this is 9 times that coordinate. The
// vertex is rotated once, and its origin once more. Adding the translation rounds the sum. Rounded up.
inline double placement_error(const Shape& shape, const Pose& pose) {
  if (pose.rotation == Mat3{} && pose.translation == Vec3{}) return 0;
  return kUnitRoundoff * (norm(pose.translation) + 20 * (max_abs(shape.origin) + shape.extent));
}

// The largest distance between the rounded origin of a hull and its exact position by the quaternion: 36 for the matrix
// (kCurvedSupportError) times sqrt(3), plus the 9 from above; rounded up.
inline double origin_error(const Shape& shape, const Pose& pose) {
  return pose.rotation == Mat3{} ? 0 : 72 * kUnitRoundoff * max_abs(shape.origin);
}

// The error of lengths whose squares underflow. It matters only for points this close to each other.
inline constexpr double kSquaresUnderflow = 1e-150;

// The noise for cores with vertices, which are judged at their rounded world coordinates. `scale`: of A - B.
inline double proof_noise(double scale, const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  return kSupportError * scale + placement_error(a, pose_a) + placement_error(b, pose_b) + kSquaresUnderflow;
}

}  // namespace satcheck
