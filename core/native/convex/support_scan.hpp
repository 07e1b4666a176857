// The vertex of a convex hull farthest along a direction: a scan over all vertices.
#pragma once

#include <vector>

#include "base/lanes.hpp"
#include "base/vec.hpp"

namespace satcheck {

// Vertices as structure of arrays, padded with copies of vertex 0 to a multiple of kLanes so that
// the scan has no remainder.
struct VertexLanes {
  static constexpr std::size_t kLanes = 8;
  std::vector<double> x, y, z;

  explicit VertexLanes(const std::vector<Vec3>& points = {});
  std::size_t padded() const { return x.size(); }
};

// A value a lane, and the index where it stood, kept as float64 so that one mask selects both.
struct LaneBest {
  Lanes value, index;
};

// Lane by lane the larger value; the one that came first in a tie.
SATCHECK_INLINE LaneBest larger(LaneBest a, LaneBest b) {
  const LaneMask takes_b = (b.value > a.value) | ((b.value == a.value) & (b.index < a.index));
  return {select(takes_b, b.value, a.value), select(takes_b, b.index, a.index)};
}

// Over all lanes.
SATCHECK_INLINE std::uint32_t index_of_largest(LaneBest best) {
  best = larger(best, {shuffle<2, 3, 0, 1>(best.value), shuffle<2, 3, 0, 1>(best.index)});
  best = larger(best, {shuffle<1, 0, 3, 2>(best.value), shuffle<1, 0, 3, 2>(best.index)});
  return static_cast<std::uint32_t>(best.index[0]);
}

// Index of the largest dot product with `direction`; the first of them in a tie. Not empty.
SATCHECK_INLINE std::uint32_t support_index(const VertexLanes& vertices, Vec3 direction) {
  const double *x = vertices.x.data(), *y = vertices.y.data(), *z = vertices.z.data();
  const Lanes dx = all_lanes(direction.x), dy = all_lanes(direction.y), dz = all_lanes(direction.z);
  const auto height = [&](std::size_t i) {
    return load_lanes(x + i) * dx + load_lanes(y + i) * dy + load_lanes(z + i) * dz;
  };
  Lanes at0 = {0, 1, 2, 3}, at1 = {4, 5, 6, 7};
  LaneBest best0 = {height(0), at0}, best1 = {height(4), at1};
  for (std::size_t i = VertexLanes::kLanes; i < vertices.padded(); i += VertexLanes::kLanes) {
    at0 = at0 + all_lanes(8);
    at1 = at1 + all_lanes(8);
    const Lanes height0 = height(i), height1 = height(i + 4);
    const LaneMask higher0 = height0 > best0.value, higher1 = height1 > best1.value;
    best0 = {select(higher0, height0, best0.value), select(higher0, at0, best0.index)};
    best1 = {select(higher1, height1, best1.value), select(higher1, at1, best1.index)};
  }
  return index_of_largest(larger(best0, best1));
}

}  // namespace satcheck
