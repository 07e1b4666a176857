#include "base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace satcheck {

void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task,
                  std::size_t chunk) {
  const std::size_t shares = (count + chunk - 1) / chunk;
  // Querying the number of cores takes as long as several pairs.
  if (threads == 0 && shares > 1) threads = std::thread::hardware_concurrency();
  threads = static_cast<unsigned>(std::min<std::size_t>(threads, shares));
  if (threads <= 1) {
    for (std::size_t i = 0; i < count; ++i) task(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::size_t failed = count;  // index of the first task that threw
  std::mutex failure_mutex;
  const auto work = [&] {
    std::size_t i = count;
    try {
      for (std::size_t from = next.fetch_add(chunk); from < count; from = next.fetch_add(chunk)) {
        for (i = from; i < std::min(from + chunk, count); ++i) task(i);
      }
    } catch (...) {  // rethrown in the caller's thread
      const std::lock_guard lock(failure_mutex);
      // All tasks before a failed task have been started, so they will finish.
      if (i < failed) {
        failed = i;
        failure = std::current_exception();
      }
      next = count;
    }
  };
  std::vector<std::thread> pool;
  pool.reserve(threads - 1);
  try {
    for (unsigned t = 1; t < threads; ++t) pool.emplace_back(work);
  } catch (const std::exception&) {  // no further thread: the existing threads do the work
  }
  work();
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace satcheck
