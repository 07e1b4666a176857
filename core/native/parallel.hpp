// A loop over independent tasks, on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace satcheck {

// Calls task(i) for i in [0, count) on `threads` threads (0: one a core), which take `chunk` indices at a
// time. Each index runs exactly once; the caller writes result i to place i, so the answer is the same at
// any thread count. The first exception thrown by a task is thrown again here after all threads have ended.
void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task,
                  std::size_t chunk = 1);

}  // namespace satcheck
