// The work of all queries on this thread so far, in steps of about a nanosecond. The code counts steps, also in exact
// arithmetic, and does not use a clock. The same input therefore has the same count on every machine.
#pragma once

#include <cstdint>

namespace satcheck {

inline constinit thread_local std::uint64_t work_done = 0;

}  // namespace satcheck
