// The depth of two meshes that are not both convex, as a proven interval. It is narrowed until it is narrow enough, beyond
// a limit, or the work is spent.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "base/best_first.hpp"
#include "base/budget.hpp"
#include "depth/depth_proof.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

struct DepthGoal {
  double upper;            // length of a known way out
  double lower = 0;        // a known lower bound of the depth
  double width = 0.01;     // wanted width of the interval, relative to its upper end
  std::uint64_t work = 0;  // steps that may be spent (base/budget.hpp)
  int across = -1;         // for a depth in a plane, the world axis along which nothing is moved; -1: none
  double limit = INFINITY;  // the search also ends once the depth is proven to be at least this
  // Writes down why no translation shorter than `upper` frees the meshes, by regions inside solids alone.
  bool prove = false;
  Poll poll = {};
};

struct DepthInterval {
  double lower = 0, upper = INFINITY;
  // way_out: a translation of A after which the meshes have no common interior; A's coordinates are rounded once. Only
  // set if it is shorter than the known way out.
  bool has_way_out = false;
  Vec3 way_out;
  // A proven upper bound of the depth: `upper` plus the rounding of the moved coordinates and of the length.
  double bound = INFINITY;
  SearchStop stop = SearchStop::narrow;  // decided: the lower end is at least the limit, up to rounding
  std::uint64_t work = 0;
  std::uint32_t boxes = 0, mesh_tests = 0, sets = 0;
  std::optional<DepthProof> proof;  // if it was asked for, and found
};

// Two overlapping meshes. Swapping them negates the way out and changes nothing else.
DepthInterval search_depth(const Surface& a, const Surface& b, const DepthGoal& goal);

}  // namespace satcheck
