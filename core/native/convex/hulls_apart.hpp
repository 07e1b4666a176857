// Whether the hulls of two large sets of points are apart, without the hulls.
#pragma once

#include <optional>
#include <vector>

#include "convex/narrow_phase.hpp"

namespace satcheck {

// The outcome, and of sets apart the bounds of the distance of their hulls: the lower one proven against every
// point, and usually within a hundredth of it. Nothing where that takes too many rounds. largest: no |coordinate|
// is greater. Neither set is empty.
std::optional<PairResult> hulls_apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double largest);

}  // namespace satcheck
