// What stands in the way of two moving surfaces, by branch and bound over their box trees.
//
// Method: conservative advancement with motion bounds for each pair of boxes and triangles, as Min Tang, Young J. Kim,
// Dinesh Manocha, "C2A: Controlled Conservative Advancement for Continuous Collision Detection of Polygonal Models"
// (2009). Where we deviate: the trees are those of the surfaces as they were placed, whose boxes turn with the body, so
// that nothing is built anew from step to step; and several axes are tried for each pair. Each is a proof by itself.
#pragma once

#include "mesh/surface.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "motion/moving.hpp"

namespace satcheck {

struct MotionAnswer {
  double value;                // a proven lower bound of what was asked
  double upper = INFINITY;     // of the distance as the bodies are now, as far as pairs were looked at
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;  // the pair that is most in the way
  std::uint64_t visits = 0;    // pairs of boxes and triangles
};

// Of the surfaces alone: what is inside a solid makes no difference. After `work` visits the answer is what is
// proven by then, which is less. Throws std::invalid_argument on an empty surface.
MotionAnswer ask_motion(const Surface& a, const Moving& moving_a, const Surface& b, const Moving& moving_b,
                        const MotionQuestion& question, const MotionRounding& rounding, std::uint64_t work);

}  // namespace satcheck
