// The Minkowski difference A - B of two placed shapes, in the frame of A.
//
// A and B overlap exactly when A - B contains the origin; its support function is the sum of
// theirs: h(n) = h_A(n) + h_B(-n). Everything below works on the cores; margins are added once,
// at the end, by the narrow phase.
#pragma once

#include "base/rounding.hpp"
#include "convex/shape.hpp"

namespace satcheck {

struct SupportPoint {
  Vec3 w;  // a - b
  Vec3 a;  // witness point on A, frame of A; the one on B is a - w
  std::uint32_t index_a = kNoIndex, index_b = kNoIndex;

  // The same vertex pair; curved shapes have no indices and compare by position.
  bool same_as(const SupportPoint& other) const {
    return index_a == other.index_a && index_b == other.index_b && w == other.w;
  }
};

struct MinkowskiDifference {
  const Shape& a;
  const Shape& b;
  Pose b_in_a;   // places B's core in A's frame
  double scale;  // bounds every coordinate of A - B: the unit of all tolerances
  const SupportMap *map_a, *map_b;  // or null
  bool curved;   // a core is curved: bounds close only in the limit

  MinkowskiDifference(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

  // The point of A - B farthest along `direction` (of any length except zero).
  SATCHECK_INLINE SupportPoint support(Vec3 direction) const {
    const Vec3 into_b = transpose_times(b_in_a.rotation, -direction);
    const CorePoint on_a = map_a ? map_a->support(a.polytope.vertices, direction) : inlined_core_support(a, direction);
    const CorePoint on_b = map_b ? map_b->support(b.polytope.vertices, into_b) : inlined_core_support(b, into_b);
    const Vec3 pb = b_in_a * on_b.point;
    return {on_a.point - pb, on_a.point, on_a.index, on_b.index};
  }

  // Upper bound on the rounding error of a support value along a unit axis.
  double support_error() const { return (curved ? kCurvedSupportError : kSupportError) * scale; }
};

// The vector from the origin of A's core to that of B's, world axes. It keeps its digits far from the world's origin,
// and also if the translations cancel large offsets of the hulls from their own origins.
Vec3 offset_between(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

// A's frame, with the recentred origin of a hull: p_world = placement * p_core.
Pose core_placement(const Shape& shape, const Pose& pose);

// The rounding error that a proof in float64 has to exceed: the largest distance that the rounding of a pose moves a
// vertex, plus the largest distance that the rounding of the pair's relative pose moves its origin. Each term of a
// rotated coordinate is rounded 3 times, and the terms sum up to the reach at most, which is sqrt(3) times the largest
// coordinate. As a vector this is 9 times that coordinate. The vertex is rotated once, and its origin once more. Adding
// the translation rounds the sum. Rounded up.
inline double placement_error(const Shape& shape, const Pose& pose) {
  if (pose.translation == Vec3{} && pose.rotation == Mat3{}) return 0;
  return kUnitRoundoff * (norm(pose.translation) + 20 * (max_abs(shape.origin) + shape.extent));
}

// The largest distance between the rounded origin of a hull and its exact position by the quaternion: 36 for the matrix
// (kCurvedSupportError) times sqrt(3), plus the 9 from above; rounded up.
inline double origin_error(const Shape& shape, const Pose& pose) {
  return pose.rotation == Mat3{} ? 0 : 72 * kUnitRoundoff * max_abs(shape.origin);
}

// The error of lengths whose squares underflow. It matters only for points this close to each other.
inline constexpr double kSquaresUnderflow = 1e-150;

// The noise for cores with vertices, which are judged at their rounded world coordinates. `scale`: of A - B; the errors:
// of both placements.
inline double proof_noise(double scale, double error_a, double error_b) {
  return kSupportError * scale + error_a + error_b + kSquaresUnderflow;
}

}  // namespace satcheck
