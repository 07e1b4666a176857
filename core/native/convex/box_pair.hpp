// Two boxes: 15 axes, and the witness points of the usual contacts.
#pragma once

#include "convex/contact_region.hpp"
#include "convex/narrow_phase.hpp"

namespace satcheck {

// The axis of least overlap, and the witness points where the contact has but one place: a corner against a
// face, or an edge across another. `sole` is false where edges or faces lie along each other, or rounding
// puts the points beside the face or the edge.
struct BoxContact {
  SatResult sat;
  Witnesses witness;
  bool sole;
};
BoxContact contact_of_boxes(const MinkowskiDifference& difference);

// check_pair() of two boxes, in either order, as far as float64 proves its answer: a depth, of an overlap
// in one place only. The outcome is `undecided` where that is left to the other stages.
PairResult overlap_of_boxes(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);
PairResult depth_of_boxes(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

}  // namespace satcheck
