// Distances of surfaces, by branch and bound over box trees: in float64, and compared with a length exactly.
#pragma once

#include <functional>
#include <optional>

#include "mesh/surface.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

struct MeshDistance {
  double distance = INFINITY;  // |witness_b - witness_a|; infinite when beyond the limit
  Vec3 witness_a, witness_b;
  std::uint32_t triangle_a = kNoIndex, triangle_b = kNoIndex;
};

// A test of one triangle of each surface.
using TrianglePairTest = std::function<bool(std::uint32_t, std::uint32_t)>;

// Distance of the two surfaces, 0 if they meet; a body inside the other has a distance, too. counts: only pairs that
// pass this test are measured; empty: all.
MeshDistance mesh_distance(const Surface& a, const Surface& b, double limit, const TrianglePairTest& counts = {},
                           Budget* budget = nullptr);

// Sign of distance - length, for surfaces without a common point. Throws BudgetSpent. poll: called now and then.
int compare_gap(const Surface& a, const Surface& b, double length, const Poll& poll = {});

}  // namespace satcheck
