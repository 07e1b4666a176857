// Two boxes: 15 axes, and the witness points of the usual contacts.
#pragma once

#include "convex/contact_region.hpp"
#include "convex/narrow_phase.hpp"

namespace satcheck {

// The axis of least overlap, and the witness points if the contact is a single point: a corner on a face, or an edge
// across another. `sole` is false if edges or faces are parallel, or if rounding puts the points outside of the face or
// the edge. noise: the rounding error that a proof has to exceed.
struct BoxContact {
  SatResult sat;
  Witnesses witness;
  bool sole;
  double noise;
};
BoxContact contact_of_boxes(const MinkowskiDifference& difference, const Pose& pose_a, const Pose& pose_b);

// check_pair() of two shapes of the kind `box`, in either order, if float64 proves the answer; else `undecided`. A depth
// is given only for an overlap with a single contact point.
PairResult overlap_of_boxes(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);
PairResult depth_of_boxes(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

}  // namespace satcheck
