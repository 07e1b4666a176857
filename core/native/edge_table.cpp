#include "edge_table.hpp"

#include <algorithm>

namespace satcheck {

// Bucket by the lower vertex number, then sort each small bucket: linear in practice.
EdgeTable::EdgeTable(std::size_t vertex_count, const std::vector<Triangle>& triangles)
    : triangles_(triangles) {
  struct Side {
    std::uint32_t upper, half_edge;
  };
  std::vector<std::uint32_t> start(vertex_count + 1, 0);
  const auto each_side = [&](auto visit) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      if (repeats_a_corner(triangles[t])) continue;
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t a = triangles[t][i], b = triangles[t][(i + 1) % 3];
        visit(std::min(a, b), std::max(a, b), 3 * t + i);
      }
    }
  };
  each_side([&](std::uint32_t lower, std::uint32_t, std::uint32_t) { ++start[lower + 1]; });
  for (std::size_t v = 0; v < vertex_count; ++v) start[v + 1] += start[v];
  std::vector<Side> sides(start.back());
  std::vector<std::uint32_t> cursor(start.begin(), start.end() - 1);
  each_side([&](std::uint32_t lower, std::uint32_t upper, std::uint32_t h) {
    sides[cursor[lower]++] = {upper, h};
  });

  half_edge_.reserve(sides.size());
  offset_.reserve(sides.size() / 2 + 2);
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto first = sides.begin() + start[v], last = sides.begin() + start[v + 1];
    std::sort(first, last, [](const Side& a, const Side& b) {
      return a.upper != b.upper ? a.upper < b.upper : a.half_edge < b.half_edge;
    });
    for (auto side = first; side != last; ++side) {
      if (side != first && side->upper != (side - 1)->upper) {
        offset_.push_back(static_cast<std::uint32_t>(half_edge_.size()));
      }
      half_edge_.push_back(side->half_edge);
    }
    if (first != last) offset_.push_back(static_cast<std::uint32_t>(half_edge_.size()));
  }
}

}  // namespace satcheck
