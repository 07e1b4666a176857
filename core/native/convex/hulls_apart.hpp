// Decides whether the hulls of two large point sets are apart, and how deep they overlap, without computing the hulls.
#pragma once

#include <optional>
#include <vector>

#include "base/budget.hpp"
#include "convex/narrow_phase.hpp"

namespace satcheck {

// Empty if it takes too many rounds, or if rounding hides whether the hulls touch. Neither set is empty. largest: the
// largest |coordinate|. budget: is polled, and pays nothing.
//
// Query::depth: what check_pair() says of the hulls, with bounds as close. Query::distance: `separated` with bounds of the
// distance, of which the lower one is proven against every point, and usually within a hundredth of the distance; any
// other outcome says only that the hulls meet.
std::optional<PairResult> check_hulls_of(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double largest, Query query,
                                         const Budget* budget = nullptr);

}  // namespace satcheck
