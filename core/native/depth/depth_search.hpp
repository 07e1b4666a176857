// The depth of two meshes that are not both convex: a proven interval, narrowed until it is narrow enough or the work
// is spent.
#pragma once

#include <cstdint>
#include <functional>

#include "mesh/surface.hpp"

namespace satcheck {

struct DepthGoal {
  double upper;            // a known way out is this long
  double lower = 0;        // known to be a lower bound of the depth
  double width = 0.01;     // the interval may stay this wide, relative to its upper end
  std::uint64_t work = 0;  // steps that may be spent (base/work.hpp)
  int across = -1;         // an axis of the world along which nothing is moved: the depth in the plane; -1: none
  std::function<void()> poll = {};  // called every twentieth of a second or so; what it throws ends the search
};

enum class DepthStop : std::uint8_t {
  narrow,      // the interval is as narrow as asked
  work_spent,  // it is what was reached
};

struct DepthInterval {
  double lower = 0, upper = INFINITY;
  // Of A: the meshes, A's coordinates rounded once, have no common interior after it. Only where `found`:
  // when it is shorter than the way out that was known.
  bool has_way_out = false;
  Vec3 way_out;
  // A proven upper bound of the depth: `upper` and the rounding of the moved coordinates and of that length.
  double bound = INFINITY;
  DepthStop stop = DepthStop::narrow;
  std::uint64_t work = 0;
  std::uint32_t boxes = 0, mesh_tests = 0, sets = 0;
};

// Two overlapping meshes. Swapping them negates the way out and changes nothing else.
DepthInterval search_depth(const Surface& a, const Surface& b, const DepthGoal& goal);

}  // namespace satcheck
