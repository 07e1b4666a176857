// Two bodies, at least one of them open: whether it depends on the fill of a hole that they overlap
// (mesh_pair/open_surfaces.hpp).
#pragma once

#include <optional>

#include "mesh_pair/mesh_pair.hpp"
#include "motion/posed_body.hpp"

namespace satcheck {

// True: the hull of a hole has a common inner point with the other body, and a point outside of it, however the vertices
// in the world are rounded by at most `rounding`. The bodies have meshes whose surfaces do not meet.
bool fills_differ(PosedBody& a, const PosedPlace& at_a, PosedBody& b, const PosedPlace& at_b, double rounding);

// The hole of that kind that comes first in a comparison of the bodies in the world: the largest one there of the only
// open body. Empty if both are open, if it is not of that kind, or if rounding may make another one the largest.
std::optional<OpenHole> open_hole(PosedBody& a, const PosedPlace& at_a, PosedBody& b, const PosedPlace& at_b,
                                  double rounding);

}  // namespace satcheck
