// The largest distance by which a surface reaches out of a solid.
#pragma once

#include "base/mesh.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

struct Deviation {
  double lower, upper;
};

// Bounds of the greatest distance between a point of the triangles of `surface_of` and the solid,
// which is 0 inside it. If `solid` is not solid, only its surface counts. upper - lower <= tolerance plus a few
// roundings of the coordinates, unless the work limit was reached.
// Throws std::invalid_argument unless the tolerance is positive and both meshes have triangles.
Deviation deviation(const Mesh& surface_of, const Surface& solid, double tolerance);

}  // namespace satcheck
