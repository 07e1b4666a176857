// Why all translations shorter than some length leave an overlap: a cube around them, cut in halves until a convex set
// of translations contains each part.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "depth/forbidden_set.hpp"

namespace satcheck {

// The hull of all differences of a point of b and a point of a, by its facets. corners: numbers of vertices of a, and of b.
struct OverlapSet {
  InnerRegion a, b;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> corners;
  std::vector<Triangle> facets;  // outward, of corners
};

// Regions are in world coordinates less the origin.
struct DepthProof {
  Vec3 origin;
  double half = 0;  // of the edge of the cube
  std::vector<OverlapSet> sets;
  // Of each part in preorder. kHalved: across its longest edge, x before y before z, the lower half first; kFar: all
  // translations in it are at least that long; else the number of a set that contains it.
  std::vector<int> parts;

  static constexpr int kHalved = -1, kFar = -2;
};

// Written while a search runs.
class DepthRecord {
 public:
  std::uint32_t add_root() { return add(); }
  // The first half; the number of the second one follows.
  std::uint32_t halve(std::uint32_t part);
  void set_far(std::uint32_t part) { parts_[part].kind = DepthProof::kFar; }
  void set_held(std::uint32_t part, std::uint32_t set) { parts_[part].kind = static_cast<int>(set); }

  // regions: of each set, in A and in B. turned: the search has moved B instead of A.
  DepthProof proof(double half, const std::vector<RegionPair>& regions, bool turned) const;

 private:
  struct Part {
    int kind = DepthProof::kFar;
    std::uint32_t first = 0;
  };

  std::uint32_t add();

  std::vector<Part> parts_;
};

}  // namespace satcheck
