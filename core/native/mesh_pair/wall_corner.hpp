// The nearest point to the origin beyond some planes.
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

// The point of least norm beyond all walls, on the last of them; nothing where no point is beyond all walls. At most
// three walls hold it, so all such sets with the last one are tried.
std::optional<Vec3> nearest_beyond(const std::vector<Wall>& walls);

}  // namespace satcheck
