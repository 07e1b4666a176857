// Is the distance of two surfaces smaller than, equal to, or larger than a length? Decided exactly.
#pragma once

#include "mesh_pair/mesh_distance.hpp"

namespace satcheck {

// Sign of distance - length, of surfaces without a common point.
int compare_gap(const Surface& a, const Surface& b, double length);

}  // namespace satcheck
