// The nearest obstacle of two moving surfaces, by branch and bound over their box trees.
//
// Method: conservative advancement with motion bounds for each pair of boxes and triangles, as Min Tang, Young J. Kim,
// Dinesh Manocha, "C2A: Controlled Conservative Advancement for Continuous Collision Detection of Polygonal Models"
// (2009). Where we deviate: the trees belong to the surfaces as placed, and their boxes turn with the body, so that no
// tree is rebuilt between steps. Several axes are tried for each pair; each is a proof by itself.
#pragma once

#include "mesh/surface.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "motion/moving.hpp"

namespace satcheck {

struct MotionAnswer {
  double value;                // a proven lower bound of the requested value
  double upper = INFINITY;     // of the distance of the bodies now, among the visited pairs
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;  // the nearest obstacle
  std::uint64_t visits = 0;    // pairs of boxes and triangles
};

// Only the surfaces count, and not the inside of solids. After `work` visits the search stops, and the answer is the
// weaker bound that is proven so far. Throws std::invalid_argument for an empty surface.
MotionAnswer ask_motion(const Surface& a, const Moving& moving_a, const Surface& b, const Moving& moving_b,
                        const MotionQuestion& question, const MotionRounding& rounding, std::uint64_t work);

}  // namespace satcheck
