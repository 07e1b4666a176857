// A loop over independent tasks, on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace satcheck {

// Calls task(i) for i in [0, count) on `threads` threads (0: one for each core; fewer if the system grants no more). A
// thread takes `chunk` indices at a time. Each index runs exactly once. The caller stores result i at index i, so the
// result does not depend on the number of threads. If tasks throw, the exception of the first one by index is rethrown
// here after all threads have ended. Tasks after it may or may not have run.
void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task,
                  std::size_t chunk = 1);

}  // namespace satcheck
