// Float64 distances leave a few pairs of triangles whose distance is about the length. Exact signs decide these.
#include "mesh_pair/gap_comparison.hpp"

#include <algorithm>

#include "base/rounding.hpp"
#include "convex/exact_distance.hpp"
#include "exact/double_double.hpp"
#include "exact/triangle_pair.hpp"

namespace satcheck {
namespace {

// Measured steps of two triangles in exact arithmetic.
constexpr std::uint64_t kComparisonWork = 10'000;

// Sign of (gap of the boxes along their widest axis - length). The triangles are at least that gap apart.
int compare_along_axes(const Aabb& a, const Aabb& b, double length) {
  int widest = -1;
  for (int axis = 0; axis < 3; ++axis) {
    for (const DoubleDouble gap : {exact_sum(a.min[axis], -b.max[axis]), exact_sum(b.min[axis], -a.max[axis])}) {
      const double beyond = gap.high != length ? gap.high - length : gap.low;
      widest = std::max(widest, beyond > 0 ? 1 : beyond < 0 ? -1 : 0);
    }
  }
  return widest;
}

class GapComparison {
 public:
  GapComparison(const Surface& a, const Surface& b, double length, const Poll& poll)
      : a_(a), b_(b), length_(length), budget_(budget_of_pair(a.mesh, b.mesh, poll)) {}

  int sign() {
    const Aabb &box_a = a_.bvh.nodes[0].box, &box_b = b_.bvh.nodes[0].box;
    const double largest = std::max({max_abs(box_a.min), max_abs(box_a.max), max_abs(box_b.min), max_abs(box_b.max)});
    // Records no nearest pair, so that the traversal visits every pair within the limit, or ends at one that settles it.
    mesh_distance(a_, b_, length_ + 2 * chain_rounding(largest), [this](std::uint32_t t, std::uint32_t u) {
      include(t, u);
      return least_ < 0;
    }, &budget_);
    return least_;
  }

 private:
  void include(std::uint32_t t, std::uint32_t u) {
    const Corners of_a = corners(a_.mesh, t), of_b = corners(b_.mesh, u);
    if (least_ < 0 || compare_along_axes(triangle_box(of_a), triangle_box(of_b), length_) >= least_) return;
    budget_.spend(kComparisonWork);
    const std::vector<Vec3> points_a(of_a.begin(), of_a.end()), points_b(of_b.begin(), of_b.end());
    const int sign = compare_distance(ExactDifference(points_a, points_b), length_);
    least_ = std::min(least_, sign);
  }

  const Surface &a_, &b_;
  double length_;
  Budget budget_;
  int least_ = 1;
};

}  // namespace

int compare_gap(const Surface& a, const Surface& b, double length, const Poll& poll) {
  return GapComparison(a, b, length, poll).sign();
}

}  // namespace satcheck
