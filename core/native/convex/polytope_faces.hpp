// From a triangulated hull to its polygonal faces, edges and extreme points.
#pragma once

#include <vector>

#include "convex/convex_hull.hpp"

namespace satcheck {

// Sets everything except `dimension` from outward triangles over `points`. Exactly coplanar neighbours become one face.
// Corners of fewer than three faces are not extreme and are left out.
// Vertices keep the order of `points`; faces are ordered by their corners.
void add_solid_faces(Polytope& polytope, const std::vector<Vec3>& points,
                     const std::vector<Triangle>& boundary,
                     const std::vector<std::uint32_t>& source);

// Sets faces, edges and triangles of a planar polygon. Its vertices are already set, in cyclic order.
void add_flat_faces(Polytope& polytope);

}  // namespace satcheck
