// Witness points of two boxes that overlap, where the contact has but one place.
#pragma once

#include <optional>

#include "convex/contact_region.hpp"
#include "convex/sat.hpp"

namespace satcheck {

// `sat` is the axis of least overlap. A corner against a face, or an edge across another; nothing where
// edges or faces lie along each other, or rounding puts the point beside the face or the edge.
std::optional<Witnesses> sole_contact_of_boxes(const MinkowskiDifference& difference, const SatResult& sat);

}  // namespace satcheck
