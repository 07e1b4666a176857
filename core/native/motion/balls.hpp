// Balls beside the surface of a body: two bodies have every point in common that lies in a ball in each.
#pragma once

#include <optional>
#include <vector>

#include "motion/posed_body.hpp"
#include "motion/posed_surfaces.hpp"

namespace satcheck {

// Some balls within a closed surface, the largest first. They touch it nowhere.
std::vector<Ball> balls_inside(const Surface& closed);

// Whether two balls have a ball with a radius of more than `depth` in common.
bool overlap(const Ball& p, const Ball& q, double depth);

// Whether one of the first and one of the second do.
bool any_overlap(const std::vector<Ball>& p, const std::vector<Ball>& q, double depth);

// A ball that a closed surface does not enter, so that it lies inside or outside as a whole.
struct ClearBall {
  Ball ball;  // in the world
  bool inside;
};

// The centre is the point that the placement takes near `point`. Empty if its radius is at most `room`, or if rounding
// hides where it lies. closed: in file coordinates. point, room: in the world.
std::optional<ClearBall> clear_ball(const Surface& closed, const PosedPlace& at, Vec3 point, double room);

// Whether a point on the way inward from a crossing of two surfaces has two such balls, inside of both, with a ball with a
// radius of more than `depth` in common.
bool ball_beside(const CommonSegment& crossing, const Surface& a, const PosedPlace& at_a, const Surface& b,
                 const PosedPlace& at_b, double depth);

// Whether the point is inside (`inside`: true) or outside (false), and farther than `room` from the surface.
bool is_clear(const Surface& closed, const PosedPlace& at, Vec3 point, double room, bool inside);

}  // namespace satcheck
