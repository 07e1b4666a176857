// Decides whether the hulls of two large point sets are apart, and how deep they overlap, without computing the hulls.
#pragma once

#include <optional>
#include <vector>

#include "base/budget.hpp"
#include "convex/narrow_phase.hpp"

namespace satcheck {

// The outcome; for separate sets, also bounds of the distance of their hulls. The lower bound is proven against every
// point, and usually within a hundredth of the distance. Empty if it takes too many rounds. largest: the largest
// |coordinate|. Neither set is empty.
std::optional<PairResult> hulls_apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double largest);

// What check_pair() with Query::depth says of the hulls, with bounds as close. Empty if it takes too many rounds, or if the
// hulls may touch. budget: is polled, and pays nothing.
std::optional<PairResult> depth_of_hulls(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double largest,
                                         const Budget* budget = nullptr);

}  // namespace satcheck
