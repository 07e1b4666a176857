// The vertex of a convex hull farthest along a direction: a scan over all vertices.
#pragma once

#include <vector>

#include "vec.hpp"

namespace satcheck {

// Vertices as structure of arrays, padded with copies of vertex 0 to a multiple of kLanes so that
// the scan has no remainder.
struct VertexLanes {
  static constexpr std::size_t kLanes = 8;
  std::vector<double> x, y, z;

  explicit VertexLanes(const std::vector<Vec3>& points = {});
  std::size_t padded() const { return x.size(); }
};

// Index of the largest dot product with `direction`; the first of them in a tie. Not empty.
std::uint32_t support_index(const VertexLanes& vertices, Vec3 direction);

}  // namespace satcheck
