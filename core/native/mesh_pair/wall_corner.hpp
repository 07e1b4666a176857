// The point beyond several planes that is nearest to the origin.
#pragma once

#include <optional>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

// The half-space normal . t >= offset, `normal` unit.
struct Wall {
  Vec3 normal;
  double offset;
};

// The point of least norm beyond all walls, on the last wall; empty if no point is beyond all walls. It lies on at most
// three walls, so all sets of up to three walls with the last one are tried.
std::optional<Vec3> nearest_beyond(const std::vector<Wall>& walls);

}  // namespace satcheck
