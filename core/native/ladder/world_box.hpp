// The first rung of the ladder: do two boxes meet whose edges follow the axes of the world?
#pragma once

#include "base/vec.hpp"

namespace satcheck {

// A proven lower bound of the distance of two closed boxes: 0 exactly when they meet.
double box_gap(const Aabb& a, const Aabb& b);

}  // namespace satcheck
