// Compares the distance of two surfaces with a length, exactly.
#pragma once

#include "mesh_pair/mesh_distance.hpp"

namespace satcheck {

// Sign of distance - length, for surfaces without a common point. Throws BudgetSpent. poll: called now and then.
int compare_gap(const Surface& a, const Surface& b, double length, const Poll& poll = {});

}  // namespace satcheck
