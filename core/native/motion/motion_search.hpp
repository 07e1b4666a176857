// The nearest obstacle of two moving bodies, by branch and bound over the box trees of their surfaces.
//
// Method: conservative advancement with motion bounds for each pair of boxes and triangles, as Min Tang, Young J. Kim,
// Dinesh Manocha, "C2A: Controlled Conservative Advancement for Continuous Collision Detection of Polygonal Models"
// (2009). Where we deviate: the trees belong to the surfaces as placed, and their boxes turn with the body, so that no
// tree is rebuilt between steps. Several axes are tried for each pair; each is a proof by itself. A convex shape is a
// tree of one part.
#pragma once

#include <limits>
#include <variant>

#include "convex/shape.hpp"
#include "mesh/surface.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "motion/moving.hpp"

namespace satcheck {

struct MotionAnswer {
  double value;                // a proven lower bound of the requested value
  double upper = INFINITY;     // of the distance of the bodies now, among the visited pairs
  std::uint32_t triangle_a = kNoIndex, triangle_b = kNoIndex;  // the nearest obstacle
  std::uint64_t visits = 0;    // pairs of boxes and triangles
};

using MovingBody = std::variant<const Surface*, const Shape*>;

// Of a surface its triangles count, and not the inside of a solid; of a shape its inside counts. For two shapes the
// value is that of the signed distance: < 0 for an overlap. Poses of shapes are rigid. After `work` visits the search
// stops, and the answer is the weaker bound that is proven so far. Throws std::invalid_argument for an empty surface.
MotionAnswer ask_motion(const MovingBody& a, const Moving& moving_a, const MovingBody& b, const Moving& moving_b,
                        const MotionQuestion& question, const MotionRounding& rounding,
                        std::uint64_t work = std::numeric_limits<std::uint64_t>::max());

}  // namespace satcheck
