// Balls in the material of a body: two bodies have every point in common that lies in a ball of each.
#pragma once

#include <vector>

#include "mesh/surface.hpp"

namespace satcheck {

struct Ball {
  Vec3 centre;
  double radius = 0;
};

// Some balls within a closed surface, the largest first. They touch it nowhere.
std::vector<Ball> balls_inside(const Surface& closed);

// Whether two balls have a ball with a radius of more than `depth` in common.
bool overlap(const Ball& p, const Ball& q, double depth);

// Whether one of the first and one of the second do.
bool any_overlap(const std::vector<Ball>& p, const std::vector<Ball>& q, double depth);

}  // namespace satcheck
