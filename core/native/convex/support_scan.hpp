// The vertex of a convex hull farthest along a direction: a scan over all vertices.
#pragma once

#include <bit>
#include <vector>

#include "base/lanes.hpp"
#include "base/vec.hpp"

namespace satcheck {

// A support point, and its index if the shape has vertices.
struct CorePoint {
  Vec3 point;
  std::uint32_t index;
};

// Vertices as structure of arrays, padded with copies of vertex 0 to a multiple of kLanes so that
// the scan has no remainder.
struct VertexLanes {
  static constexpr std::size_t kLanes = 8;
  std::vector<double> x, y, z;

  explicit VertexLanes(const std::vector<Vec3>& points = {}) {
    if (points.empty()) return;
    const std::size_t count = (points.size() + kLanes - 1) / kLanes * kLanes;
    x.resize(count, points[0].x);
    y.resize(count, points[0].y);
    z.resize(count, points[0].z);
    for (std::size_t i = 0; i < points.size(); ++i) {
      x[i] = points[i].x;
      y[i] = points[i].y;
      z[i] = points[i].z;
    }
  }
  std::size_t padded() const { return x.size(); }
};

// Dot products of a direction with four points.
struct LaneDirection {
  Lanes x, y, z;

  SATCHECK_INLINE explicit LaneDirection(Vec3 d) : x(all_lanes(d.x)), y(all_lanes(d.y)), z(all_lanes(d.z)) {}
  SATCHECK_INLINE Lanes heights(const double* px, const double* py, const double* pz) const {
    return load_lanes(px) * x + load_lanes(py) * y + load_lanes(pz) * z;
  }
  SATCHECK_INLINE Lanes heights(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) const {
    return Lanes{p.x, q.x, r.x, s.x} * x + Lanes{p.y, q.y, r.y, s.y} * y + Lanes{p.z, q.z, r.z, s.z} * z;
  }
};

// A value for each lane, and its index, stored as float64 so that one mask selects both.
struct LaneBest {
  Lanes value, index;
};

// Lane by lane the larger value; the one that came first in a tie.
SATCHECK_INLINE LaneBest larger(LaneBest a, LaneBest b) {
  const LaneMask takes_b = (b.value > a.value) | ((b.value == a.value) & (b.index < a.index));
  return {select(takes_b, b.value, a.value), select(takes_b, b.index, a.index)};
}

// The index of the largest over all lanes.
SATCHECK_INLINE std::uint32_t index_of_largest(LaneBest best) {
  best = larger(best, {shuffle<2, 3, 0, 1>(best.value), shuffle<2, 3, 0, 1>(best.index)});
  best = larger(best, {shuffle<1, 0, 3, 2>(best.value), shuffle<1, 0, 3, 2>(best.index)});
  return static_cast<std::uint32_t>(best.index[0]);
}

// The largest over all lanes, in each lane.
SATCHECK_INLINE Lanes largest_in_all(Lanes v) {
  v = larger(v, shuffle<2, 3, 0, 1>(v));
  return larger(v, shuffle<1, 0, 3, 2>(v));
}

// Finds the largest height, then its index. With a compile-time count of vectors, the heights of up to 32 points stay
// in registers.
SATCHECK_INLINE std::uint32_t support_index_of_few(const double* x, const double* y, const double* z, int vectors,
                                                   Vec3 direction) {
  const LaneDirection d(direction);
  Lanes height[ManyLaneBits::kVectors], best = height[0] = d.heights(x, y, z);
  for (int k = 1; k < vectors; ++k) {
    height[k] = d.heights(x + 4 * k, y + 4 * k, z + 4 * k);
    best = larger(best, height[k]);
  }
  best = largest_in_all(best);
  ManyLaneBits places;
  for (int k = 0; k < vectors; ++k) places.add(height[k] == best, k);
  // If a height is nan, there may be no bit. Then any point is returned.
  return static_cast<std::uint32_t>(std::countr_zero(places.bits() | 1ull << (4 * vectors - 1)));
}

// Index of the largest dot product with `direction` among `padded` points, a multiple of 8 above 0; the first of
// them in a tie.
SATCHECK_INLINE std::uint32_t support_index(const double* x, const double* y, const double* z, std::size_t padded,
                                            Vec3 direction) {
  if (padded == 16) return support_index_of_few(x, y, z, 4, direction);
  if (padded == 32) return support_index_of_few(x, y, z, 8, direction);
  if (padded == 8) return support_index_of_few(x, y, z, 2, direction);
  if (padded <= 4 * ManyLaneBits::kVectors) return support_index_of_few(x, y, z, static_cast<int>(padded / 4), direction);
  const LaneDirection d(direction);
  Lanes at0 = {0, 1, 2, 3}, at1 = {4, 5, 6, 7};
  LaneBest best0 = {d.heights(x, y, z), at0}, best1 = {d.heights(x + 4, y + 4, z + 4), at1};
  for (std::size_t i = VertexLanes::kLanes; i < padded; i += VertexLanes::kLanes) {
    at0 = at0 + all_lanes(8);
    at1 = at1 + all_lanes(8);
    const Lanes height0 = d.heights(x + i, y + i, z + i), height1 = d.heights(x + i + 4, y + i + 4, z + i + 4);
    const LaneMask higher0 = height0 > best0.value, higher1 = height1 > best1.value;
    best0 = {select(higher0, height0, best0.value), select(higher0, at0, best0.index)};
    best1 = {select(higher1, height1, best1.value), select(higher1, at1, best1.index)};
  }
  return index_of_largest(larger(best0, best1));
}

SATCHECK_INLINE std::uint32_t support_index(const VertexLanes& vertices, Vec3 direction) {
  return support_index(vertices.x.data(), vertices.y.data(), vertices.z.data(), vertices.padded(), direction);
}

}  // namespace satcheck
