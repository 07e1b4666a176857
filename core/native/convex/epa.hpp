// EPA on signed face distances: penetration depth of two convex shapes, with proven bounds.
#pragma once

#include <vector>

#include "convex/gjk.hpp"

namespace satcheck {

struct EpaResult {
  enum class Status {
    depth,      // the bounds met
    bounded,    // curved shapes: the bounds hold, but did not close
    separated,  // an axis of negative support value: the shapes do not overlap
    flat,       // A - B has no volume (both shapes lie in one plane): `axis` is its normal
    stalled,    // rounding broke the polytope before the bounds met: no answer
  };
  Status status = Status::stalled;
  // Signed penetration: min over unit axes n of the support value h(n) of A - B; positive inside.
  double lower = -INFINITY, upper = INFINITY;
  Vec3 axis;          // unit, A to B: the axis of `upper`
  Simplex facet;      // the facet of A - B on that axis, weighted at the origin's projection
  int iterations = 0;
};

// `seed` may be the last simplex of GJK, which saves the first support points. Stops as soon as the penetration is
// proven to be more than `enough`; the facet is then not set.
EpaResult epa(const MinkowskiDifference& difference, const Simplex& seed, double enough = INFINITY);

}  // namespace satcheck
