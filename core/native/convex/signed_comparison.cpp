// Each shape is a core with a ball around it. The distance of the cores is compared with the length plus both radii.
#include "convex/signed_comparison.hpp"

#include "convex/exact_depth.hpp"
#include "convex/exact_distance.hpp"
#include "convex/exact_pair.hpp"
#include "convex/minkowski.hpp"
#include "convex/proof_noise.hpp"
#include "convex/world_hull.hpp"

namespace satcheck {

std::optional<int> compare_signed_distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                                           double length) {
  const MinkowskiDifference m(a, pose_a, b, pose_b);
  if (m.curved) return std::nullopt;
  const Polytope core_a = WorldHull(a, pose_a).polytope(), core_b = WorldHull(b, pose_b).polytope();
  const Dyadic of_cores = Dyadic(length) + Dyadic(a.margin) + Dyadic(b.margin);
  const ExactDifference difference(core_a.vertices, core_b.vertices);
  switch (decide_exactly(core_a, core_b, 2 * proof_noise(m.scale, a, pose_a, b, pose_b))) {
    case Outcome::separated:
      return compare_distance(difference, of_cores);
    case Outcome::penetrating:
      return -compare_depth(difference, -of_cores);
    default:
      return (-of_cores).sign();
  }
}

}  // namespace satcheck
