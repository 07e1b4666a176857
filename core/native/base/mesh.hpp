// A triangle mesh: plain arrays, no topology and no cache.
#pragma once

#include <vector>

#include "base/vec.hpp"

namespace satcheck {

struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

}  // namespace satcheck
