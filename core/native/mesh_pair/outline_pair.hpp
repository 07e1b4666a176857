// The relation of two prisms across one axis, one of which ends beyond both ends of the other: that of their outlines,
// decided in the plane.
#pragma once

#include <optional>

#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

// As mesh_relation(). Empty for other surfaces.
std::optional<MeshRelation> prism_relation(const Surface& a, const Surface& b);

}  // namespace satcheck
