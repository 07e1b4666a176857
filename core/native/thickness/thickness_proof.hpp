// Why no point lies deeper in two bodies: the cells of a search as a tree, with a reason for each cell that was not divided.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "thickness/cell.hpp"
#include "thickness/two_bodies.hpp"

namespace satcheck {

// A convex function that is no smaller than the depth in a body: the distance from triangles that together are flat and
// convex, or that from a plane, normal . p = height, where the body has nothing beyond it within `reach` of the cell.
struct DepthBound {
  int body = 0;
  std::vector<std::uint32_t> triangles;  // none: a plane
  HalfSpace plane;
  double reach = INFINITY;
};

// The coordinates are those of the world less the origin.
struct ThicknessProof {
  Vec3 origin, low, high;  // the box of the root
  std::vector<DepthBound> bounds;
  // Of each node, in preorder. 0, 1, 2: divided across that axis at the next of `at`; 3: by the next of `cuts`, the side
  // with normal . p <= height first; 4, 5: outside of A, of B; 6: bounded by the next of `sums`.
  std::vector<int> cells;
  std::vector<double> at;
  std::vector<HalfSpace> cuts;
  std::vector<std::vector<std::pair<std::uint32_t, double>>> sums;  // numbers of bounds, and weights

  void swap_bodies();
};

// A column of a sum that bounds the depth in a cell.
struct Term {
  Column column;
  double reach;  // of a plane
  double weight;
};

// Written while a search runs.
class ThicknessRecord {
 public:
  // What bounds the depth in a node is at first what bounds it in the one that it comes from.
  std::uint32_t add_root();
  std::pair<std::uint32_t, std::uint32_t> divide(std::uint32_t node, const HalfSpace& plane);
  void set_outside(std::uint32_t node, int body);
  void set_bound(std::uint32_t node, std::vector<Term> terms);

  // box: of the root. No ball in both bodies is larger than that.
  ThicknessProof proof(const TwoBodies& bodies, Vec3 origin, const Aabb& box) const;

 private:
  struct Node {
    int kind;
    HalfSpace plane;
    std::uint32_t first;  // child; the second one follows
    std::vector<Term> terms;
  };
  class Writer;

  std::vector<Node> nodes_;
};

}  // namespace satcheck
