// Witness points of an overlap along a given axis: the middle of the contact region.
#pragma once

#include "convex/minkowski.hpp"

namespace satcheck {

struct Witnesses {
  Vec3 a, b;  // on A and on B, frame of A; a - b = penetration * axis
};

// `axis` is a unit facet normal of A - B (A to B) with the given support value. The support features
// of both shapes (vertex, edge or face) are projected along it and clipped against each other.
Witnesses contact_region_centre(const MinkowskiDifference& difference, Vec3 axis, double penetration);

}  // namespace satcheck
