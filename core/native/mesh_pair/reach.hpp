// How far a surface reaches out of a solid, and whether it reaches deeper into one than a length.
#pragma once

#include <cstdint>
#include <optional>

#include "mesh/surface.hpp"

namespace satcheck {

struct Deviation {
  double lower, upper;
};

// Bounds of the greatest distance between a point of the triangles of `surface_of` and the solid, which is 0 inside it.
// If `solid` is not solid, only its surface counts. upper - lower <= tolerance plus a few roundings of the coordinates,
// unless the work limit was reached. Throws std::invalid_argument unless the tolerance is positive and both meshes have
// triangles.
Deviation deviation(const Mesh& surface_of, const Surface& solid, double tolerance, Budget& budget);

// Whether a point of the triangles of `surface_of` lies inside the solid, farther than `length` from all triangles of it,
// to rounding. Nothing where the budget, which stops, does not suffice to decide that.
std::optional<bool> reaches_deeper(const Mesh& surface_of, const Surface& solid, double length, Budget& budget);

}  // namespace satcheck
