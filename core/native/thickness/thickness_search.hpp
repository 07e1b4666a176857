// The thickness of an overlap: the diameter of the largest ball inside both of two solids, as a proven interval.
//
// With d_X(p) the distance from p, inside X, to the nearest triangle of X, and lengths e_A and e_B, the search bounds
// 2 max over p inside both of min(d_A(p) - e_A, d_B(p) - e_B). Lengths of 0 give the thickness. Where A and B have no
// common point, and wherever it is smaller, the value is that of the surfaces: -2 max(e_A, e_B).
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "base/best_first.hpp"
#include "base/budget.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

struct ThicknessProof;

// Unit axes, perpendicular up to rounding, and the least and the greatest coordinate along each.
struct BoxAlong {
  Mat3 axes;
  Vec3 low, high;
};

struct ThicknessGoal {
  double width = 0.01;     // the interval may stay this wide, relative to its upper end
  // Steps that may be spent (base/budget.hpp). The search may spend more: it finishes the cells that it has begun, and its
  // preparation has no budget.
  std::uint64_t work = 0;
  double less_a = 0, less_b = 0;  // e_A and e_B, world units
  std::optional<double> limit = {};  // the search ends as soon as the interval lies on one side of this length
  double most = INFINITY;  // the thickness is known to be no more
  // An axis of the world along which both solids are prisms: triangles across it do not count; -1: none.
  int across = -1;
  bool prove = false;  // write down why no point lies deeper; not along an axis
  // A box around a component of the overlap, world frame: its balls lie in it. One of another component may be found that
  // has its centre in the box.
  std::optional<BoxAlong> within = {};
  unsigned threads = 1;  // 0: one for each core; the answer does not depend on it
  Poll poll = {};
};

struct ThicknessInterval {
  double lower = 0, upper = 0;  // of the diameter, rounding included
  bool found = false;           // whether a point inside both is known that is as deep as `lower` says
  Vec3 centre;                  // that point, world frame
  double radius = 0;            // no triangle of either surface is nearer to it, rounding included
  SearchStop stop = SearchStop::narrow;
  std::uint64_t work = 0;
  std::uint32_t boxes = 0;  // that were bounded
  std::shared_ptr<ThicknessProof> proof;  // of upper, where it was asked for
};

// Swapping the surfaces, and less_a with less_b, changes nothing. Throws std::invalid_argument unless both are solids.
ThicknessInterval search_thickness(const Surface& a, const Surface& b, const ThicknessGoal& goal);

}  // namespace satcheck
