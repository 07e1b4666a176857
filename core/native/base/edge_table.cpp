#include "base/edge_table.hpp"

#include <algorithm>
#include <numeric>

namespace satcheck {

// Bucket by the lower vertex number, then sort each small bucket: linear in practice.
EdgeTable::EdgeTable(std::size_t vertex_count, const std::vector<Triangle>& triangles)
    : triangles_(triangles) {
  std::vector<std::uint32_t> start(vertex_count + 1, 0);
  const auto each_side = [&](auto visit) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const auto [a, b, c] = triangles[t];
      if (repeats_a_corner(triangles[t])) continue;
      visit(std::min(a, b), std::max(a, b), 3 * t);
      visit(std::min(b, c), std::max(b, c), 3 * t + 1);
      visit(std::min(c, a), std::max(c, a), 3 * t + 2);
    }
  };
  each_side([&](std::uint32_t lower, std::uint32_t, std::uint32_t) { ++start[lower + 1]; });
  std::inclusive_scan(start.begin(), start.end(), start.begin());
  std::vector<std::uint64_t> sides(start.back());  // the upper vertex, then the half-edge
  std::vector<std::uint32_t> place(start.begin(), start.end() - 1);
  each_side([&](std::uint32_t lower, std::uint32_t upper, std::uint32_t h) {
    sides[place[lower]++] = std::uint64_t{upper} << 32 | h;
  });

  half_edge_.resize(sides.size());
  offset_.reserve(sides.size() / 2 + 2);
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const std::uint32_t first = start[v], last = start[v + 1];
    std::sort(sides.begin() + first, sides.begin() + last);
    for (std::uint32_t i = first; i < last; ++i) {
      if (i != first && sides[i] >> 32 != sides[i - 1] >> 32) offset_.push_back(i);
      half_edge_[i] = static_cast<std::uint32_t>(sides[i]);
    }
    if (first != last) offset_.push_back(last);
  }
}

std::vector<std::uint32_t> EdgeTable::twins() const {
  std::vector<std::uint32_t> twins(3 * triangles_.size(), kNoIndex);
  for (std::size_t e = 0; e < size(); ++e) {
    const auto h = half_edges(e);
    if (h.size() == 2) twins[h[0]] = h[1], twins[h[1]] = h[0];
  }
  return twins;
}

}  // namespace satcheck
