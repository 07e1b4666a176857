// GJK: the distance of two convex shapes from their support functions.
#pragma once

#include "convex/simplex.hpp"

namespace satcheck {

struct GjkResult {
  enum class Status {
    separated,  // `lower` > the rounding error of a support value: the axis is a proof
    encloses,   // a tetrahedron of support points around the origin
    contact,    // too close to decide by distances: |v| is rounding noise
  };
  Status status = Status::contact;
  Simplex simplex;    // carries v; four vertices when it encloses
  Vec3 v;                    // closest point of A - B to the origin so far
  double upper;              // |v|: the distance is at most this
  double lower = -INFINITY;  // the distance is at least this: the best support value along a queried axis
  Vec3 axis;                 // unit; lower = min over A - B of axis . w
  int iterations = 0;

  explicit GjkResult(const SupportPoint& first) : simplex(first), v(first.w), upper(norm(first.w)) {}
};

// Continues until the bounds meet up to rounding, a support point repeats, or a step does not come closer. No better
// float64 answer is then possible, and [lower, upper] states its error.
GjkResult gjk(const MinkowskiDifference& difference);

}  // namespace satcheck
