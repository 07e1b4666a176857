// Finds the close pairs among many boxes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/bvh.hpp"

namespace satcheck {

// A proven lower bound of the distance of two closed boxes: 0 exactly when they meet.
double box_gap(const Aabb& a, const Aabb& b);

using IndexPair = std::array<std::uint32_t, 2>;

// A query for close pairs. reach: two boxes are close if box_gap() is at most the sum of their reaches.
// kind: pairs of boxes whose kinds are in `exempt_kinds` are left out, and so are the pairs in `exempt`. In both lists
// the lower number comes first, and a kind may be paired with itself.
struct CloseQuery {
  std::vector<Aabb> boxes;
  std::vector<double> reach;
  std::vector<std::uint32_t> kind;
  std::vector<IndexPair> exempt_kinds, exempt;
};

// The close pairs (i, j), i < j, sorted. They are found body by body, as far as they are taken, so that they need no
// memory of their own.
class ClosePairs {
 public:
  explicit ClosePairs(CloseQuery query);
  // The next pairs, at most `most`; fewer only at the end.
  std::vector<IndexPair> take(std::size_t most);
  // The number of all close pairs, taken or not.
  std::size_t count() const;

 private:
  // Of all boxes below a node: their kind, or that it is mixed, the highest number, how many they are, and what all of
  // them reach: a box meets each of them if it meets this one, whose min may exceed its max.
  struct Below {
    std::uint32_t kind, last, count;
    Aabb shared;
  };

  // Calls found(j) for the boxes from `lowest` on that are close to box i, in any order; passes over what lies below a
  // node if is_done(below) says so.
  template <class IsDone, class Found>
  void visit_close(std::uint32_t i, std::uint32_t lowest, const IsDone& is_done, const Found& found) const;
  bool are_exempt(std::uint32_t kind_a, std::uint32_t kind_b) const;
  void sum_up_nodes();

  CloseQuery query_;
  Bvh bvh_;  // over the boxes grown by their reaches
  std::vector<Below> below_;
  std::uint32_t next_ = 0;  // the box whose partners come after those in partners_
  std::uint32_t current_ = 0;
  std::vector<std::uint32_t> partners_;  // of current_, not yet taken, the highest first
};

}  // namespace satcheck
