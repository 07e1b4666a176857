// The shortest translations of bodies that keep a set of walls: a convex quadratic program.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

// normal . (t[a] - t[b]) >= least, for translations t of the bodies a and b. normal: unit.
struct PairWall {
  std::uint32_t a, b;
  Vec3 normal;
  double least;
};

// translations: 0 for bodies that are not movable or have no wall. multipliers: how far each wall pushes its bodies, >=
// 0; a translation is the sum of the pushes of its walls.
struct LeastMotion {
  std::vector<Vec3> translations;
  std::vector<double> multipliers;
};

// Minimises the sum of the squared translations. multipliers: of an earlier solution for similar walls, or zeros. Each
// wall has at least one movable body. If walls contradict each other, some are broken.
LeastMotion least_motion(const std::vector<bool>& movable, const std::vector<PairWall>& walls,
                         std::vector<double> multipliers);

}  // namespace satcheck
