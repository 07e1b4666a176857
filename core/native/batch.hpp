// Many convex pairs at once, on all cores.
#pragma once

#include <functional>

#include "narrow_phase.hpp"

namespace satcheck {

// Calls task(i) for i in [0, count) on `threads` threads (0: one a core). Each index runs exactly
// once; the caller writes result i to place i, so the answer is the same at any thread count. The
// first exception thrown by a task is thrown again here after all threads have ended.
void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task);

struct PairRequest {
  const Shape* a;
  const Shape* b;
  Pose pose_a, pose_b;
};

std::vector<PairResult> check_pairs(const std::vector<PairRequest>& requests, Query query, MethodChoice method,
                                    unsigned threads);

}  // namespace satcheck
