#include "batch.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace satcheck {

namespace {

// Pairs handed out at a time: enough to make the counter free, few enough to balance the ends.
constexpr std::size_t kChunk = 64;

}  // namespace

void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task) {
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  threads = static_cast<unsigned>(std::min<std::size_t>(threads, (count + kChunk - 1) / kChunk));
  if (threads <= 1) {
    for (std::size_t i = 0; i < count; ++i) task(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (std::size_t from = next.fetch_add(kChunk); from < count; from = next.fetch_add(kChunk)) {
        for (std::size_t i = from; i < std::min(from + kChunk, count); ++i) task(i);
      }
    } catch (...) {  // carried to the caller's thread, not swallowed
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> pool;
  for (unsigned t = 1; t < threads; ++t) pool.emplace_back(work);
  work();
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

std::vector<PairResult> check_pairs(const std::vector<PairRequest>& requests, Query query, MethodChoice method,
                                    unsigned threads) {
  std::vector<PairResult> results(requests.size());
  parallel_for(requests.size(), threads, [&](std::size_t i) {
    const PairRequest& r = requests[i];
    results[i] = check_pair(*r.a, r.pose_a, *r.b, r.pose_b, query, method);
  });
  return results;
}

}  // namespace satcheck
