// Connected sets of triangles of a welded mesh.
#pragma once

#include <algorithm>
#include <vector>

#include "base/edge_table.hpp"
#include "base/mesh.hpp"

namespace satcheck {

// Disjoint sets of 0..n-1; the representative of a set is its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n);
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // Returns whether they were in different sets.
  bool unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

// Labels run from 0 in order of the first triangle of each set.
struct Labels {
  std::vector<std::uint32_t> of_triangle;
  std::size_t count = 0;

  std::vector<std::vector<std::uint32_t>> members() const;
};

// Sets with a boundary: an edge that their triangles run more often in one direction than in the other.
std::vector<bool> find_open_sets(const Labels& labels, const EdgeTable& edges);

// Flaps: sets that are removed one after another, as long as a set has an open edge at which no other set remains. For
// example, a wall within a closed box is a flap if it does not reach the box all around.
std::vector<bool> find_flaps(const Labels& labels, const EdgeTable& edges);

// Sets connected through shared edges with any number of triangles.
Labels label_components(const Mesh& welded, const EdgeTable& edges);

// Sets connected through shared vertices.
Labels label_vertex_components(const Mesh& welded);

// Sets connected through edges of exactly two triangles.
Labels label_manifold_patches(const Mesh& welded, const EdgeTable& edges);

}  // namespace satcheck
