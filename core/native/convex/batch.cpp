#include "convex/batch.hpp"

#include "base/parallel.hpp"

namespace satcheck {
namespace {

// Pairs handed out at a time: enough to make the counter free, few enough to balance the ends.
constexpr std::size_t kChunk = 64;

}  // namespace

std::vector<PairResult> check_pairs(std::size_t count, const std::function<PairRequest(std::size_t)>& request,
                                    Query query, MethodChoice method, unsigned threads) {
  std::vector<PairResult> results(count);
  parallel_for(count, threads, [&](std::size_t i) {
    const PairRequest r = request(i);
    results[i] = check_pair(*r.a, r.pose_a, *r.b, r.pose_b, query, method);
  }, kChunk);
  return results;
}

}  // namespace satcheck
