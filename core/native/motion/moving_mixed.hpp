// What stands in the way of a moving convex shape and a moving surface.
#pragma once

#include "convex/shape.hpp"
#include "motion/moving_surfaces.hpp"

namespace satcheck {

// As for two surfaces; the shape counts with its inside. The pair that is most in the way: triangle_b alone.
MotionAnswer ask_motion(const Shape& a, const Moving& moving_a, const Surface& b, const Moving& moving_b,
                        const MotionQuestion& question, const MotionRounding& rounding, std::uint64_t work);

}  // namespace satcheck
