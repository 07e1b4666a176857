// The verdict on flush neighbours: a face of one hull separates the other one from it, in exact signs.
#pragma once

#include <optional>

#include "convex/narrow_phase.hpp"
#include "convex/shape.hpp"

namespace satcheck {

// `axis` points from A to B, in the world, and is close to the one that separates best; only the face of A that looks
// most along it, and the face of B that looks most against it, are tested.
//
// touching: the plane of such a face separates the hulls weakly, and they have a common point. separated: it separates
// them, and they have none. Empty: neither face separates, which proves nothing.
std::optional<Outcome> outcome_by_face(const WorldHull& a, const WorldHull& b, Vec3 axis);

}  // namespace satcheck
