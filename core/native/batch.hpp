// Many convex pairs at once, on all cores.
#pragma once

#include <vector>

#include "narrow_phase.hpp"

namespace satcheck {

struct PairRequest {
  const Shape* a;
  const Shape* b;
  Pose pose_a, pose_b;
};

std::vector<PairResult> check_pairs(const std::vector<PairRequest>& requests, Query query, MethodChoice method,
                                    unsigned threads);

}  // namespace satcheck
