// The separating axis test: signed penetration of two polytopes by trying every axis that can be a
// facet normal of their Minkowski difference.
//
// Two disjoint convex polytopes are separated along a face normal of one of them or along the cross product of an edge
// of each. If they overlap, one of the same axes has the least overlap (S. Gottschalk,
// M. C. Lin, D. Manocha, "OBBTree", 1996; D. Gregorius, "The Separating Axis Test between Convex
// Polyhedra", GDC 2013).
#pragma once

#include "convex/minkowski.hpp"

namespace satcheck {

enum class Feature : std::uint8_t { none, face_a, face_b, edge_edge, vertices, curved };

struct SatResult {
  // min over the axes n of h_A(n) + h_B(-n): the length of the translation of A along -n that frees it. Negative: n
  // separates, with this gap.
  double penetration = INFINITY;
  double lower = -INFINITY;  // no axis has less, up to the rounding of a support value
  Vec3 axis;  // unit, from A to B, frame of A
  Feature feature = Feature::none;
  std::uint32_t index_a = kNoIndex;  // face or edge of the polytope of A
  std::uint32_t index_b = kNoIndex;
  int axes_tested = 0;
};

enum class SatGoal { any_separating_axis, least_overlap };

// Two solid polytopes over the face normals of both and the edge pairs whose arcs cross on the Gauss map.
SatResult sat_polytopes(const MinkowskiDifference& difference, SatGoal goal);

}  // namespace satcheck
