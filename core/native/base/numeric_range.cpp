#include "base/numeric_range.hpp"

#include <stdexcept>
#include <string>

#include "base/lanes.hpp"

namespace satcheck {
namespace {

// Four points are three Lanes: x y z x, y z x y, z x y z.
struct ThreeLanes {
  Lanes lane[3];
};

struct Extent {
  bool all_in_range = true;
  Aabb box;

  void include(Vec3 p) {
    all_in_range = all_in_range && in_range(p.x) && in_range(p.y) && in_range(p.z);
    box.include(p);
  }
};

SATCHECK_WIDE Extent measure(const Vec3* points, std::size_t count) {
  Extent extent;
  const Lanes largest = all_lanes(kLargestCoordinate);
  const Lanes infinite = all_lanes(INFINITY);
  ThreeLanes low{{infinite, infinite, infinite}}, high{{-infinite, -infinite, -infinite}};
  LaneMask fine = largest == largest;
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    for (int k = 0; k < 3; ++k) {
      const Lanes c = load_lanes(&points[i].x + 4 * k);
      fine = fine & (abs(c) <= largest);
      low.lane[k] = smaller(c, low.lane[k]);
      high.lane[k] = larger(c, high.lane[k]);
    }
  }
  for (; i < count; ++i) extent.include(points[i]);
  extent.all_in_range &= bits_of(fine) == 15;
  double least_of[12], largest_of[12];
  for (int k = 0; k < 3; ++k) {
    store_lanes(least_of + 4 * k, low.lane[k]);
    store_lanes(largest_of + 4 * k, high.lane[k]);
  }
  for (int p = 0; p < 12; p += 3) {
    extent.box.include(Aabb{{least_of[p], least_of[p + 1], least_of[p + 2]}, {largest_of[p], largest_of[p + 1], largest_of[p + 2]}});
  }
  return extent;
}

}  // namespace

bool are_in_range(std::span<const Vec3> points) {
  const Extent extent = measure(points.data(), points.size());
  const double size = points.empty() ? 0 : max_abs(extent.box.max - extent.box.min);
  return extent.all_in_range && (size == 0 || size >= kSmallestSize);
}

void require_in_range(std::span<const Vec3> points, const char* what) {
  if (are_in_range(points)) return;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i];
    if (in_range(p.x) && in_range(p.y) && in_range(p.z)) continue;
    const std::string where = std::string(what) + " " + std::to_string(i);
    if (!is_finite(p)) throw std::invalid_argument(where + " is not finite");
    throw std::overflow_error(where + " is out of range: a coordinate is beyond 1e45; use a larger unit of length");
  }
  throw std::overflow_error("the size is out of range: it is below 1e-45; use a smaller unit of length");
}

}  // namespace satcheck
