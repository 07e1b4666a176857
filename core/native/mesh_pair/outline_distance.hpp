// The distance of two prisms across one axis, of different heights: that of their outlines, in the plane.
#pragma once

#include <optional>

#include "mesh_pair/mesh_distance.hpp"

namespace satcheck {

// As mesh_distance(). Empty for other surfaces, for outlines that cross, and if the ends of the prisms may be nearer to
// each other than their walls.
std::optional<MeshDistance> prism_distance(const Surface& a, const Surface& b, double limit);

}  // namespace satcheck
