// The motion bounds of two moving convex shapes.
#pragma once

#include "convex/shape.hpp"
#include "motion/moving_surfaces.hpp"

namespace satcheck {

// As for surfaces, with the signed distance instead of the gap: < 0 for an overlap. Poses are rigid.
MotionAnswer ask_motion(const Shape& a, const Moving& moving_a, const Shape& b, const Moving& moving_b,
                        const MotionQuestion& question, const MotionRounding& rounding);

}  // namespace satcheck
