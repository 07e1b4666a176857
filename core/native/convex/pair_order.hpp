// Which of two placed shapes comes first, whatever the order in which they were named.
//
// A query is answered in the frame of its first shape, and rounding follows that frame: answering in one
// order and mirroring the answer makes A against B and B against A the same bits.
#pragma once

#include "convex/narrow_phase.hpp"

namespace satcheck {

// Compares all that the shapes are, then where they stand.
bool comes_before_in_full(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

// No scaling changes the result. Most shapes of a kind differ in what is compared first.
inline bool comes_before(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  if (a.kind == b.kind && a.extent != b.extent) return a.extent < b.extent;
  return comes_before_in_full(a, pose_a, b, pose_b);
}

// Turns it into the answer to the question with A and B exchanged.
void mirror(PairResult& result);

}  // namespace satcheck
