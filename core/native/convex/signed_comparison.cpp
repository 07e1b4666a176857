// Each shape is a core with a ball around it. The distance of the cores is compared with the length plus both radii.
#include "convex/signed_comparison.hpp"

#include "convex/exact_depth.hpp"
#include "convex/exact_distance.hpp"
#include "convex/minkowski.hpp"
#include "convex/world_hull.hpp"

namespace satcheck {

std::optional<int> compare_signed_distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                                           double length) {
  if (MinkowskiDifference(a, pose_a, b, pose_b).curved) return std::nullopt;
  const ExactDifference difference(world_points(a, pose_a), world_points(b, pose_b));
  const Dyadic of_cores = Dyadic(length) + Dyadic(a.margin) + Dyadic(b.margin);
  return of_cores.sign() > 0 ? compare_distance(difference, of_cores) : -compare_depth(difference, -of_cores);
}

}  // namespace satcheck
