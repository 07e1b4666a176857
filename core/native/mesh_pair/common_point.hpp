// A point inside both of two solids, as far from both surfaces as a short climb gets.
#pragma once

#include <cmath>
#include <optional>

#include "mesh/surface.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

struct CommonPoint {
  Vec3 point;
  double depth;  // distance from the nearer surface, rounded
};

// Starts from the evidence of a relation with a common interior, and ends at a point deeper than `enough`. Nothing where
// no point with a proven winding number was found.
std::optional<CommonPoint> common_point(const Surface& a, const Surface& b, const MeshRelation& relation,
                                        double enough = INFINITY);

}  // namespace satcheck
