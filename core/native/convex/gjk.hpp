// GJK: the distance of two convex shapes from their support functions alone.
#pragma once

#include "convex/simplex.hpp"

namespace satcheck {

struct GjkResult {
  enum class Status {
    separated,  // `lower` > the rounding error of a support value: the axis is a proof
    encloses,   // a tetrahedron of support points around the origin
    contact,    // too close to call with distances: |v| is rounding noise
  };
  Status status = Status::contact;
  Simplex simplex;    // carries v; four vertices when it encloses
  Vec3 v;             // closest point of A - B to the origin found
  double upper = 0;   // |v|: the distance is at most this
  double lower = 0;   // and at least this: the best support value along a queried axis
  Vec3 axis;          // unit; lower = min over A - B of axis . w
  int iterations = 0;
};

// Goes on until the bounds meet to rounding, or a support point repeats, or the next step would not come closer: then no
// better float64 answer can be reached, and [lower, upper] says how good it is.
GjkResult gjk(const MinkowskiDifference& difference);

}  // namespace satcheck
