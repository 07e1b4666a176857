// Many convex pairs at once, on all cores.
#pragma once

#include <cstddef>
#include <functional>

#include "convex/pair_results.hpp"

namespace satcheck {

struct PairRequest {
  const Shape* a;
  const Shape* b;
  Pose pose_a, pose_b;
};

// check_pair() on request(0), ..., request(count - 1). request(i) is called once, by the thread that needs it. If some
// throw, the exception of the first one is rethrown.
PairResults check_pairs(std::size_t count, const std::function<PairRequest(std::size_t)>& request, Query query,
                        MethodChoice method, unsigned threads);

}  // namespace satcheck
