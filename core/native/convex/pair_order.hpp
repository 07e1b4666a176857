// Which of two placed shapes comes first, whatever the order in which they were named.
//
// A query is answered in the frame of its first shape, and rounding follows that frame: answering in one
// order and mirroring the answer makes A against B and B against A the same bits.
#pragma once

#include "convex/narrow_phase.hpp"

namespace satcheck {

// Compares what the shapes are, then where they stand; no scaling changes the result.
bool comes_before(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

// Turns it into the answer to the question with A and B exchanged.
void mirror(PairResult& result);

}  // namespace satcheck
