// A point deep in both of two bodies that overlap: the quick proof that a touch band does not explain the overlap.
#pragma once

#include "convex/narrow_phase.hpp"
#include "mesh/surface.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

// Whether a point deeper than `least` in both solids was found. False: there may still be one. relation: with a common
// interior. largest: the largest |coordinate| of both. Throws BudgetSpent.
bool has_thick_point(const Surface& a, const Surface& b, const MeshRelation& relation, double largest, double least,
                     Budget* budget = nullptr);

// The same for convex solids that overlap, by the planes of their triangles. hulls: their signed distance.
bool has_thick_point(const Mesh& a, const Mesh& b, const PairResult& hulls, double least);

}  // namespace satcheck
