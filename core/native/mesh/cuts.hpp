// The segments in which triangles meet the plane of another one.
#pragma once

#include <vector>

#include "base/mesh.hpp"
#include "mesh/flat_cells.hpp"

namespace satcheck {

// What cuts the open triangle t of `mesh` where triangles of `other` (which may be the same mesh) meet
// it: edges in its plane, and the segments in which triangles cross it. Edges between two partners that
// continue each other in the plane cut nothing: the other surface is the same on both sides. With
// Touching::kept every common point of t and a partner is on a segment too.
std::vector<PlaneSegment> find_cuts(const Mesh& mesh, std::uint32_t t, const Mesh& other,
                                    const std::vector<std::uint32_t>& partners, Touching touching);

}  // namespace satcheck
