// A loop over independent tasks, on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace satcheck {

// Calls task(i) for i in [0, count) on `threads` threads (0: one a core; fewer where the system grants no more),
// which take `chunk` indices at a time. Each index runs exactly once; the caller writes result i to place i, so
// the answer is the same at any thread count. The exception of the first task that throws is thrown again here
// after all threads have ended; which tasks after it have run is left open.
void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task,
                  std::size_t chunk = 1);

}  // namespace satcheck
