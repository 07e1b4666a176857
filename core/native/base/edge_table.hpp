// The undirected edges of a triangle mesh and the half-edges on each.
#pragma once

#include <span>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

// Half-edge h = 3 t + i runs from corner i to corner i + 1 of triangle t. A triangle that names a corner twice has no
// half-edges.
class EdgeTable {
 public:
  EdgeTable(std::size_t vertex_count, const std::vector<Triangle>& triangles);

  std::size_t size() const { return offset_.size() - 1; }
  std::span<const std::uint32_t> half_edges(std::size_t edge) const {
    return {half_edge_.data() + offset_[edge], half_edge_.data() + offset_[edge + 1]};
  }
  // Of each half-edge the other one at its edge, or kNoIndex where an edge does not have exactly two.
  std::vector<std::uint32_t> twins() const;
  // Does the half-edge run from the lower to the higher vertex number?
  bool ascends(std::uint32_t h) const {
    return triangles_[h / 3][h % 3] < triangles_[h / 3][(h % 3 + 1) % 3];
  }
  // The number of triangles that run the edge upward, minus those that run it downward.
  int balance(std::size_t edge) const {
    int sum = 0;
    for (const std::uint32_t h : half_edges(edge)) sum += ascends(h) ? 1 : -1;
    return sum;
  }
  // Whether triangles run each edge equally often in both directions.
  bool is_balanced() const {
    for (std::size_t e = 0; e < size(); ++e) {
      if (balance(e) != 0) return false;
    }
    return true;
  }

 private:
  const std::vector<Triangle>& triangles_;
  std::vector<std::uint32_t> half_edge_;
  std::vector<std::uint32_t> offset_{0};
};

inline bool repeats_a_corner(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

}  // namespace satcheck
