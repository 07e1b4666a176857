// Method: one tree over all boxes, that of bvh.cpp, walked once for each box. Unlike a sweep along an axis, it takes time
// near n log n if there are few pairs. Each box is grown outward by its reach, so that the walk misses no pair. The gap
// of the boxes themselves then decides.
#include "ladder/broad_phase.hpp"

#include <algorithm>
#include <utility>

#include "base/rounding.hpp"

namespace satcheck {
namespace {

constexpr std::uint32_t kMixed = 0xFFFFFFFF;

// Contains every point within `reach` of the box, rounding included; also if two reaches are summed first.
Aabb grown(const Aabb& box, double reach) {
  const double by = reach * (1 + 4 * kUnitRoundoff);
  const auto below = [&](double c) { return std::nextafter(c - by, -INFINITY); };
  const auto above = [&](double c) { return std::nextafter(c + by, INFINITY); };
  return {{below(box.min.x), below(box.min.y), below(box.min.z)},
          {above(box.max.x), above(box.max.y), above(box.max.z)}};
}

// pairs: sorted.
bool holds(const std::vector<IndexPair>& pairs, std::uint32_t i, std::uint32_t j) {
  return !pairs.empty() && std::binary_search(pairs.begin(), pairs.end(), IndexPair{std::min(i, j), std::max(i, j)});
}

}  // namespace

double box_gap(const Aabb& a, const Aabb& b) {
  const auto along = [&](int axis) {
    return std::fmax(std::fmax(b.min[axis] - a.max[axis], a.min[axis] - b.max[axis]), 0.0);
  };
  const Vec3 gap{along(0), along(1), along(2)};
  // The largest is rounded once, and so is its product with the factor below 1. The root has roundings of each
  // difference, 4 of the norm, and that of the product: less than 8.
  const double diagonal = scaled_norm(gap);
  return std::fmax(max_abs(gap) * (1 - kUnitRoundoff), diagonal * (1 - 8 * kUnitRoundoff));
}

ClosePairs::ClosePairs(CloseQuery query) : query_(std::move(query)) {
  std::sort(query_.exempt_kinds.begin(), query_.exempt_kinds.end());
  std::sort(query_.exempt.begin(), query_.exempt.end());
  std::vector<Aabb> reached(query_.boxes.size());
  for (std::size_t i = 0; i < reached.size(); ++i) reached[i] = grown(query_.boxes[i], query_.reach[i]);
  bvh_ = build_bvh_by_form(reached);
  sum_up_nodes();
}

void ClosePairs::sum_up_nodes() {
  below_.resize(bvh_.nodes.size());
  const auto join = [](Below& sum, const Below& more) {
    const auto &s = sum.shared, &m = more.shared;
    const Aabb shared{{std::fmax(s.min.x, m.min.x), std::fmax(s.min.y, m.min.y), std::fmax(s.min.z, m.min.z)},
                      {std::fmin(s.max.x, m.max.x), std::fmin(s.max.y, m.max.y), std::fmin(s.max.z, m.max.z)}};
    sum = {sum.kind == more.kind ? sum.kind : kMixed, std::max(sum.last, more.last), sum.count + more.count, shared};
  };
  for (std::size_t k = bvh_.nodes.size(); k-- > 0;) {  // children come after their parents
    const BvhNode& node = bvh_.nodes[k];
    if (node.is_leaf()) {
      const auto of_box = [&](std::uint32_t place) {
        const std::uint32_t number = bvh_.order[place];
        return Below{query_.kind[number], number, 1, query_.boxes[number]};
      };
      below_[k] = of_box(node.first);
      for (std::uint32_t l = node.first + 1; l < node.first + node.count; ++l) join(below_[k], of_box(l));
    } else {
      below_[k] = below_[node.first];
      join(below_[k], below_[node.first + 1]);
    }
  }
}

bool ClosePairs::are_exempt(std::uint32_t kind_a, std::uint32_t kind_b) const {
  return kind_b != kMixed && holds(query_.exempt_kinds, kind_a, kind_b);
}

template <class IsDone, class Found>
void ClosePairs::visit_close(std::uint32_t i, std::uint32_t lowest, const IsDone& is_done, const Found& found) const {
  const Aabb &box = query_.boxes[i], reached = grown(box, query_.reach[i]);
  const std::uint32_t kind = query_.kind[i];
  std::vector<std::uint32_t> stack{0};
  stack.reserve(kUsualDepth);
  while (!stack.empty()) {
    const std::uint32_t k = stack.back();
    const BvhNode& node = bvh_.nodes[k];
    stack.pop_back();
    if (below_[k].last < lowest || !meet(node.box, reached) || are_exempt(kind, below_[k].kind)) continue;
    if (is_done(below_[k])) continue;
    if (!node.is_leaf()) {
      stack.insert(stack.end(), {node.first, node.first + 1});
      continue;
    }
    for (std::uint32_t l = node.first; l < node.first + node.count; ++l) {
      const std::uint32_t j = bvh_.order[l];
      if (j < lowest || !meet(bvh_.boxes[l], reached)) continue;
      if (!(box_gap(box, query_.boxes[j]) <= query_.reach[i] + query_.reach[j])) continue;
      if (!are_exempt(kind, query_.kind[j]) && !holds(query_.exempt, i, j)) found(j);
    }
  }
}

std::vector<IndexPair> ClosePairs::take(std::size_t most) {
  std::vector<IndexPair> pairs;
  while (pairs.size() < most) {
    if (!partners_.empty()) {
      pairs.push_back({current_, partners_.back()});
      partners_.pop_back();
    } else if (next_ < query_.boxes.size()) {
      current_ = next_++;
      const auto never = [](const Below&) { return false; };
      visit_close(current_, current_ + 1, never, [&](std::uint32_t j) { partners_.push_back(j); });
      std::sort(partners_.rbegin(), partners_.rend());
    } else {
      break;
    }
  }
  return pairs;
}

// Each pair is found from both of its boxes, and each box as close to itself. Boxes of one kind that all meet box i are
// counted at once: bodies in one heap make more pairs than can be visited.
std::size_t ClosePairs::count() const {
  std::size_t found = 0;
  for (std::uint32_t i = 0; i < query_.boxes.size(); ++i) {
    const auto is_done = [&](const Below& below) {
      if (below.kind == kMixed || !query_.exempt.empty() || !meet(below.shared, query_.boxes[i])) return false;
      found += below.count;
      return true;
    };
    visit_close(i, 0, is_done, [&](std::uint32_t) { ++found; });
    if (!are_exempt(query_.kind[i], query_.kind[i])) --found;
  }
  return found / 2;
}

}  // namespace satcheck
