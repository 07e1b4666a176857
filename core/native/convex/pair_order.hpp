// A canonical order of two placed shapes, independent of the order in which they are given.
//
// A query is computed in the frame of its first shape, and rounding depends on this frame. Computing in the canonical
// order and mirroring the result gives the same bits for A against B and B against A.
#pragma once

#include "convex/narrow_phase.hpp"

namespace satcheck {

// Compares all data of the shapes, then their poses.
bool comes_before_in_full(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

// Scaling does not change the result. Most shapes of a kind already differ in the first comparison.
inline bool comes_before(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  if (a.kind == b.kind && a.extent != b.extent) return a.extent < b.extent;
  return comes_before_in_full(a, pose_a, b, pose_b);
}

// Turns the result into that of the query with A and B exchanged.
void mirror(PairResult& result);

}  // namespace satcheck
