// Method: Ingo Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies" (2007): binned
// surface area heuristic. The splits depend on the coordinates and the triangle order alone.
#include "bvh.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace satcheck {
namespace {

constexpr std::uint32_t kLeafSize = 4;  // triangles that are not worth a split
constexpr int kBins = 16;

double half_area(const Aabb& box) {
  const Vec3 e = box.max - box.min;
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

struct Bin {
  Aabb box;
  std::uint32_t count = 0;
};

class Builder {
 public:
  explicit Builder(const Mesh& mesh) : boxes_(mesh.triangles.size()), centre_(boxes_.size()) {
    bvh_.order.resize(boxes_.size());
    std::iota(bvh_.order.begin(), bvh_.order.end(), 0u);
    for (std::uint32_t t = 0; t < boxes_.size(); ++t) {
      boxes_[t] = triangle_box(mesh, t);
      centre_[t] = boxes_[t].min * 0.5 + boxes_[t].max * 0.5;
    }
  }

  Bvh build() {
    if (boxes_.empty()) return {};
    bvh_.nodes.reserve(boxes_.size());
    struct Range {
      std::uint32_t node, first, count;
    };
    bvh_.nodes.emplace_back();
    std::vector<Range> pending{{0, 0, static_cast<std::uint32_t>(boxes_.size())}};
    while (!pending.empty()) {
      const Range range = pending.back();
      pending.pop_back();
      BvhNode node;
      Aabb centres;
      for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
        include(node.box, boxes_[bvh_.order[i]]);
        centres.include(centre_[bvh_.order[i]]);
      }
      if (range.count <= kLeafSize) {
        node.first = range.first;
        node.count = range.count;
        bvh_.nodes[range.node] = node;
        continue;
      }
      const std::uint32_t left = split(range.first, range.count, centres);
      node.first = static_cast<std::uint32_t>(bvh_.nodes.size());
      bvh_.nodes[range.node] = node;
      bvh_.nodes.resize(bvh_.nodes.size() + 2);
      pending.push_back({node.first + 1, range.first + left, range.count - left});
      pending.push_back({node.first, range.first, left});
    }
    return std::move(bvh_);
  }

 private:
  // Reorders the range and returns how many triangles go left, at least 1 and not all.
  std::uint32_t split(std::uint32_t first, std::uint32_t count, const Aabb& centres) {
    const Vec3 extent = centres.max - centres.min;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto begin = bvh_.order.begin() + first, end = begin + count;
    const double scale = kBins / extent[axis];
    if (extent[axis] > 0 && std::isfinite(scale)) {
      const auto bin_of = [&](std::uint32_t t) {
        const int bin = static_cast<int>((centre_[t][axis] - centres.min[axis]) * scale);
        return std::clamp(bin, 0, kBins - 1);
      };
      const int border = best_border(begin, end, bin_of);
      const auto middle =
          std::stable_partition(begin, end, [&](std::uint32_t t) { return bin_of(t) < border; });
      const auto left = static_cast<std::uint32_t>(middle - begin);
      if (left > 0 && left < count) return left;
    }
    return count / 2;
  }

  template <class Iterator, class BinOf>
  int best_border(Iterator begin, Iterator end, BinOf bin_of) const {
    std::array<Bin, kBins> bins;
    for (auto i = begin; i != end; ++i) {
      Bin& bin = bins[static_cast<std::size_t>(bin_of(*i))];
      include(bin.box, boxes_[*i]);
      ++bin.count;
    }
    std::array<double, kBins> left_cost{};
    Bin left;
    for (int b = 1; b < kBins; ++b) {
      include(left.box, bins[b - 1].box);
      left.count += bins[b - 1].count;
      left_cost[b] = left.count == 0 ? INFINITY : half_area(left.box) * left.count;
    }
    Bin right;
    int border = kBins / 2;
    double lowest = INFINITY;
    for (int b = kBins - 1; b > 0; --b) {
      include(right.box, bins[b].box);
      right.count += bins[b].count;
      if (right.count == 0) continue;
      const double cost = left_cost[b] + half_area(right.box) * right.count;
      if (cost < lowest) {
        lowest = cost;
        border = b;
      }
    }
    return border;
  }

  Bvh bvh_;
  std::vector<Aabb> boxes_;
  std::vector<Vec3> centre_;
};

}  // namespace

Bvh build_bvh(const Mesh& mesh) { return Builder(mesh).build(); }

}  // namespace satcheck
