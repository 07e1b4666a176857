// Lower bounds of the depth of an overlap that need no search: what the touch band asks first.
#pragma once

#include "mesh_pair/mesh_pair.hpp"
#include "scene/geometry.hpp"

namespace satcheck {

// From one pair of triangles that cross, as they stand; 0 where they prove nothing. A translation that frees A
// leaves no two triangles crossing on which the bodies end: beside such a crossing both have material. That holds
// wherever along them they cross only if the bodies end on all of both triangles.
double crossing_depth(const Surface& a, const Surface& b, std::uint32_t triangle_a, std::uint32_t triangle_b);

// Whether they prove a depth of more than `length`, exactly.
bool crosses_deeper(const Surface& a, const Surface& b, std::uint32_t triangle_a, std::uint32_t triangle_b, double length);

// Of nested bodies: the inner one stays inside at least until the surfaces meet.
double nested_depth(PlacedGeometry& a, PlacedGeometry& b);

// The better one of the two, for a pair of this relation. largest: no |coordinate| of the two is greater.
double least_depth(const Surface& a, const Surface& b, double largest, const MeshRelation& relation);

}  // namespace satcheck
