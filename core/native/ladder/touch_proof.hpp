// What shows without a search that a touch band does not explain an overlap: lower bounds of its depth, and a point deep in
// both bodies.
#pragma once

#include "convex/narrow_phase.hpp"
#include "ladder/geometry.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

// A lower bound from one pair of triangles that cross; 0 if they prove nothing. Beside a crossing of two boundary
// triangles, both bodies have material. A translation that frees A must therefore end every such crossing. This holds
// for all crossings of the pair only if both triangles are completely boundary.
double crossing_depth(const Surface& a, const Surface& b, std::uint32_t triangle_a, std::uint32_t triangle_b);

// Whether they prove a depth of more than `length`, decided exactly.
bool crosses_deeper(const Surface& a, const Surface& b, std::uint32_t triangle_a, std::uint32_t triangle_b, double length);

// For nested bodies: the inner one stays inside at least until the surfaces meet. Throws BudgetSpent. poll: called now
// and then.
double nested_depth(PlacedGeometry& a, PlacedGeometry& b, const Poll& poll = {});

// The bound that applies to this relation. largest: the largest |coordinate| of both. Throws BudgetSpent.
double least_depth(const Surface& a, const Surface& b, double largest, const MeshRelation& relation, Budget* budget = nullptr);

// Whether a point deeper than `least` in both solids was found. False: there may still be one. relation: with a common
// interior. largest: the largest |coordinate| of both. Throws BudgetSpent.
bool has_thick_point(const Surface& a, const Surface& b, const MeshRelation& relation, double largest, double least,
                     Budget* budget = nullptr);

// The same for convex solids that overlap, by the planes of their triangles. hulls: their signed distance.
bool has_thick_point(const Mesh& a, const Mesh& b, const PairResult& hulls, double least);

}  // namespace satcheck
