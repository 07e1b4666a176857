// The nearest obstacle of a moving convex shape and a moving surface.
#pragma once

#include "convex/shape.hpp"
#include "motion/moving_surfaces.hpp"

namespace satcheck {

// As for two surfaces. The inside of the shape counts. Only triangle_b of the nearest obstacle is set.
MotionAnswer ask_motion(const Shape& a, const Moving& moving_a, const Surface& b, const Moving& moving_b,
                        const MotionQuestion& question, const MotionRounding& rounding, std::uint64_t work);

}  // namespace satcheck
