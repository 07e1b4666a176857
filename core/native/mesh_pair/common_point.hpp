// A point inside both of two solids, moved away from both surfaces by a short climb.
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

// Starts from the evidence of a relation with a common interior, and ends at a point deeper than `enough`; both solids
// contain it for certain. Empty if no point with a proven winding number was found.
std::optional<CommonPoint> common_point(const Surface& a, const Surface& b, const MeshRelation& relation,
                                        double enough = INFINITY, Budget* budget = nullptr);

}  // namespace satcheck
