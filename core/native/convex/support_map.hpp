// For each direction, the few vertices of a convex hull that can be farthest along it. The result equals that of a scan
// over all vertices, but most vertices are not visited.
//
// The directions are cut into cells, squares on an octahedron around the origin that is unfolded to a square
// (E. Praun, H. Hoppe, "Spherical Parametrization and Remeshing", 2003). A cell stores all vertices, except those for
// which another vertex is higher at the four corners of the cell. That vertex is then higher in the whole cell, because
// the directions of a cell are sums of its corner directions. It is higher by more than all rounding, so the scan of a
// cell and the scan of all vertices give the same result, bit by bit.
#pragma once

#include <atomic>
#include <bit>
#include <memory>
#include <vector>

#include "convex/support_scan.hpp"

namespace satcheck {

class SupportMap {
 public:
  // Finite points, at least one.
  explicit SupportMap(const std::vector<Vec3>& points);

  // The same point as support_index() over all points, which are those that the map was made of. For direction 0, any
  // point.
  SATCHECK_INLINE CorePoint support(const std::vector<Vec3>& points, Vec3 direction) const {
    const Cell cell = cells_[cell_of(direction)];
    const std::uint32_t* places = places_.data() + cell.first;
    Best best = highest(points, places, direction);
    for (std::uint32_t i = kBlock; i < cell.count; i += kBlock) {
      const Best other = highest(points, places + i, direction);
      if (other.height > best.height) best = other;
    }
    return {points[best.index], best.index};
  }

 private:
  static constexpr std::uint32_t kBlock = 8;
  struct Cell {
    std::uint32_t first, count;  // of its vertices in places_; a multiple of kBlock, with copies of the first
  };
  struct Best {
    double height;
    std::uint32_t index;
  };
  class Builder;

  SATCHECK_INLINE static Best highest(const std::vector<Vec3>& points, const std::uint32_t* i, Vec3 direction) {
    const Vec3* p = points.data();
    const LaneDirection d(direction);
    const Lanes low = d.heights(p[i[0]], p[i[1]], p[i[2]], p[i[3]]);
    const Lanes high = d.heights(p[i[4]], p[i[5]], p[i[6]], p[i[7]]);
    Lanes best = larger(low, high);
    best = larger(best, shuffle<2, 3, 0, 1>(best));
    best = larger(best, shuffle<1, 0, 3, 2>(best));
    const int places = bits_of(low == best) | bits_of(high == best) << 4;
    return {best[0], i[std::countr_zero(static_cast<unsigned>(places) | 1u << (kBlock - 1))]};
  }

  // The upper half of the octahedron |x| + |y| + |z| = 1 seen from above, the faces of the lower half folded out.
  SATCHECK_INLINE std::uint32_t cell_of(Vec3 d) const {
    const Lanes upper = Lanes{d.x, d.y, 0, 0} / all_lanes(std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
    const Lanes across = all_lanes(1) - abs(shuffle<1, 0, 3, 2>(upper)), zero = all_lanes(0);
    const Lanes lower = select(upper < zero, -across, across);
    const Lanes place = (select(all_lanes(d.z) < zero, lower, upper) + all_lanes(1)) * all_lanes(0.5 * side_);
    const auto step = [&](double along) {
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(smaller(along, side_ - 1)));
    };
    return (step(place[0]) << log_side_) + step(place[1]);
  }

  int log_side_ = 0;  // of the cells along an edge of the square
  double side_ = 1;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> places_;  // vertices, cell by cell, ascending
};

// The map of a shape. It is made after enough queries to pay off. Copies share it.
class LazySupportMap {
 public:
  LazySupportMap() = default;  // never made
  explicit LazySupportMap(std::size_t vertex_count);

  // Counts a query, from any thread. Null: scan the vertices.
  const SupportMap* for_query(const std::vector<Vec3>& vertices) const {
    if (!state_) return nullptr;
    const SupportMap* map = state_->map.load(std::memory_order_acquire);
    return map ? map : count(vertices);
  }

 private:
  struct State {
    std::atomic<int> queries = 0;
    std::unique_ptr<const SupportMap> owner;
    std::atomic<const SupportMap*> map = nullptr;
  };
  const SupportMap* count(const std::vector<Vec3>& vertices) const;

  std::shared_ptr<State> state_;
};

}  // namespace satcheck
