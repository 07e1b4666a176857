#include "convex/batch.hpp"

#include "base/parallel.hpp"

namespace satcheck {

PairResults check_pairs(std::size_t count, const std::function<PairRequest(std::size_t)>& request, Query query,
                        MethodChoice method, unsigned threads) {
  PairResults results(count, query != Query::overlap);
  // With blocks of this size the shared counter costs nothing, and they are small enough for an even load.
  parallel_for(count, threads, [&](std::size_t i) {
    const PairRequest r = request(i);
    results.set(i, check_pair(*r.a, r.pose_a, *r.b, r.pose_b, query, method));
  }, kRowsOfALine);
  return results;
}

}  // namespace satcheck
