#include "convex/support_map.hpp"

#include <algorithm>

#include "base/rounding.hpp"

namespace satcheck {

namespace {

constexpr std::size_t kLanes = VertexLanes::kLanes;

// With fewer vertices a scan is as fast.
constexpr std::size_t kFewestVertices = 64;
// The number of queries that save about the cost of the map.
constexpr int kQueriesToPay = 256;

// A vertex is excluded from a cell only if another one is higher by more than this fraction of the extent. For a
// direction with |x| + |y| + |z| = 1, the place on the unfolded octahedron has an error of 8 roundoffs for each
// coordinate, the direction 32 in sum, and two heights along it twice 32. Each height has 3 roundings in a query and 3
// here, and the limit has 1. The sum is 77.
constexpr double kBeaten = 128 * kUnitRoundoff;

}  // namespace

// Vertices that can be farthest, in the order of their indices. Entries from `count` to `padded`, a multiple of kLanes,
// are copies of the first.
struct Candidates {
  std::vector<double> x, y, z;
  std::vector<std::uint32_t> index, kept;
  std::size_t count = 0, padded = 0;

  explicit Candidates(std::size_t capacity) : x(capacity), y(capacity), z(capacity), index(capacity), kept(capacity) {}
  Vec3 point(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, Vec3 p, std::uint32_t p_index) {
    x[i] = p.x;
    y[i] = p.y;
    z[i] = p.z;
    index[i] = p_index;
  }
  void pad() {
    for (padded = count; padded % kLanes != 0; ++padded) set(padded, point(0), index[0]);
  }
};

namespace {

// The direction at a place of the unfolded octahedron, u and v from -1 to 1. Exact at grid points.
Vec3 folded(double u, double v) {
  const double across_u = 1 - std::fabs(v), across_v = 1 - std::fabs(u), z = across_v - std::fabs(v);
  return z >= 0 ? Vec3{u, v, z} : Vec3{std::copysign(across_u, u), std::copysign(across_v, v), z};
}

// The candidates in `from`, except those that the one farthest along `middle` exceeds by more than `margin` at all
// corners.
SATCHECK_WIDE void keep_unbeaten(const Candidates& from, Vec3 middle, const Vec3 corner[4], double margin,
                                 Candidates& to) {
  const double *x = from.x.data(), *y = from.y.data(), *z = from.z.data();
  const Vec3 top = from.point(support_index(x, y, z, from.padded, middle));
  const LaneDirection d0(corner[0]), d1(corner[1]), d2(corner[2]), d3(corner[3]);
  const Lanes limit0 = all_lanes(dot(corner[0], top) - margin), limit1 = all_lanes(dot(corner[1], top) - margin);
  const Lanes limit2 = all_lanes(dot(corner[2], top) - margin), limit3 = all_lanes(dot(corner[3], top) - margin);
  std::uint32_t* kept = to.kept.data();
  std::size_t count = 0;
  for (std::size_t i = 0; i < from.padded; i += 4) {
    const LaneMask beaten = (d0.heights(x + i, y + i, z + i) < limit0) & (d1.heights(x + i, y + i, z + i) < limit1) &
                            (d2.heights(x + i, y + i, z + i) < limit2) & (d3.heights(x + i, y + i, z + i) < limit3);
    const int bits = ~bits_of(beaten);
    for (std::size_t l = 0; l < 4; ++l) {  // without a branch, which would be unpredictable
      kept[count] = static_cast<std::uint32_t>(i + l);
      count += bits >> l & 1;
    }
  }
  while (kept[count - 1] >= from.count) --count;
  to.count = count;
  for (std::size_t i = 0; i < count; ++i) to.set(i, from.point(kept[i]), from.index[kept[i]]);
  to.pad();
}

}  // namespace

// Divides squares into quarters, down to the cells. The candidates of a quarter are among those of its square.
class SupportMap::Builder {
 public:
  Builder(SupportMap& map, const std::vector<Vec3>& points) : map_(map) {
    levels_.assign(static_cast<std::size_t>(map.log_side_) + 2, Candidates(points.size() + kLanes));
    Candidates& all = levels_.front();
    for (Vec3 p : points) {
      all.set(all.count, p, static_cast<std::uint32_t>(all.count));
      ++all.count;
      margin_ = std::fmax(margin_, kBeaten * max_abs(p));
    }
    all.pad();
    fill({0, 0, 1u << map.log_side_}, 1);
  }

 private:
  struct Square {
    std::uint32_t u, v, size;  // in cells
  };

  void fill(Square s, std::size_t level) {
    const double step = 2 / map_.side_, u = step * s.u - 1, v = step * s.v - 1, width = step * s.size;
    const Vec3 corner[4] = {folded(u, v), folded(u + width, v), folded(u, v + width), folded(u + width, v + width)};
    Candidates& kept = levels_[level];
    keep_unbeaten(levels_[level - 1], folded(u + width / 2, v + width / 2), corner, margin_, kept);
    if (s.size == 1 || kept.count <= kBlock) return write(kept, s);
    const std::uint32_t half = s.size / 2;
    for (std::uint32_t i : {s.u, s.u + half}) {
      for (std::uint32_t j : {s.v, s.v + half}) fill({i, j, half}, level + 1);
    }
  }

  void write(const Candidates& kept, Square s) {
    const Cell cell{static_cast<std::uint32_t>(map_.places_.size()), static_cast<std::uint32_t>(kept.padded)};
    map_.places_.insert(map_.places_.end(), kept.index.data(), kept.index.data() + kept.padded);
    for (std::uint32_t u = s.u; u < s.u + s.size; ++u) {
      std::fill_n(map_.cells_.data() + (u << map_.log_side_) + s.v, s.size, cell);
    }
  }

  SupportMap& map_;
  std::vector<Candidates> levels_;
  double margin_ = 0;
};

SupportMap::SupportMap(const std::vector<Vec3>& points) {
  // Enough cells that most have one block.
  while (log_side_ < 6 && std::size_t{1} << 2 * log_side_ < 2 * points.size()) ++log_side_;
  side_ = 1 << log_side_;
  cells_.resize(std::size_t{1} << 2 * log_side_);
  Builder(*this, points);
}

LazySupportMap::LazySupportMap(std::size_t vertex_count) {
  if (vertex_count >= kFewestVertices) state_ = std::make_shared<State>();
}

const SupportMap* LazySupportMap::count(const std::vector<Vec3>& vertices) const {
  if (state_->queries.fetch_add(1, std::memory_order_relaxed) + 1 != kQueriesToPay) return nullptr;
  state_->owner = std::make_unique<const SupportMap>(vertices);
  state_->map.store(state_->owner.get(), std::memory_order_release);
  return state_->owner.get();
}

}  // namespace satcheck
