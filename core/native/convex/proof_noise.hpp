// The rounding that a proof in float64 has to beat.
#pragma once

#include "base/tolerances.hpp"
#include "convex/shape.hpp"

namespace satcheck {

// How far the rounding of a pose moves a vertex at most. In a coordinate 3 products and 2 sums make 5
// roundings of no more than the reach of the turned vertex, sqrt(3) times its largest coordinate: as a
// vector, 15 of that coordinate. Adding the translation rounds the sum; rounded up.
inline double placement_error(const Shape& shape, const Pose& pose) {
  if (pose.rotation == Mat3{} && pose.translation == Vec3{}) return 0;
  return kUnitRoundoff * (norm(pose.translation) + 20 * (max_abs(shape.origin) + shape.extent));
}

// Of cores that are vertices, which are judged where their poses round them to. `scale` is that of A - B.
inline double proof_noise(double scale, const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  return kSupportError * scale + placement_error(a, pose_a) + placement_error(b, pose_b);
}

}  // namespace satcheck
