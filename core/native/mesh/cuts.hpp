// The segments in which triangles meet the plane of another one.
#pragma once

#include <vector>

#include "base/mesh.hpp"
#include "mesh/flat_cells.hpp"

namespace satcheck {

// The segments in which triangles of `other` (perhaps the same mesh) cut the open triangle t of `mesh`: edges in its
// plane, and crossings of triangles. Edges between two partners that continue each other in the plane are left out,
// because the other surface is the same on both sides. With Touching::kept, every common point of t and a partner is
// also on a segment.
std::vector<PlaneSegment> find_cuts(const Mesh& mesh, std::uint32_t t, const Mesh& other,
                                    const std::vector<std::uint32_t>& partners, Touching touching, Budget* budget = nullptr);

}  // namespace satcheck
