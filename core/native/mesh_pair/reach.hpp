// How far a surface reaches out of a solid, and whether it reaches deeper into one than a length.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/surface.hpp"

namespace satcheck {

// point: of the surface, at least `lower` away to rounding. narrow: the interval is as narrow as requested.
struct Deviation {
  double lower, upper;
  Vec3 point;
  bool narrow;
};

// Bounds of the greatest distance between a point of the triangles of `surface_of` and the union of the solids, which is 0
// inside it. Of those that are not solid only the surface counts. upper - lower is at most the larger one of `tolerance` and
// ratio * lower, plus a few roundings of the coordinates, unless the work limit or the budget was reached; each triangle is
// looked at once in any case. Throws std::invalid_argument unless the tolerance is positive and all meshes have triangles.
Deviation deviation(const Mesh& surface_of, const std::vector<const Surface*>& solids, double tolerance, double ratio, Budget& budget);

// Whether a point of the triangles of `surface_of` lies inside the solid, farther than `length` from all triangles of it,
// to rounding. Nothing where the budget, which stops, does not suffice to decide that.
std::optional<bool> reaches_deeper(const Mesh& surface_of, const Surface& solid, double length, Budget& budget);

}  // namespace satcheck
