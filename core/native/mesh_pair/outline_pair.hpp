// Two prisms across one axis, one of which ends beyond both ends of the other: their relation and their distance are those
// of their outlines, in the plane.
#pragma once

#include <optional>

#include "mesh_pair/mesh_distance.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

// As mesh_relation(). Empty for other surfaces.
std::optional<MeshRelation> prism_relation(const Surface& a, const Surface& b);

// As mesh_distance(). Empty for other surfaces, for outlines that cross, and if the ends of the prisms may be nearer to
// each other than their walls.
std::optional<MeshDistance> prism_distance(const Surface& a, const Surface& b, double limit);

}  // namespace satcheck
