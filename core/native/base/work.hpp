// The work of all queries on this thread so far, in steps of about a nanosecond. Steps are counted where the work is
// done, also in exact arithmetic, and not by a clock: the same input has the same count on every machine.
#pragma once

#include <cstdint>

namespace satcheck {

inline constinit thread_local std::uint64_t work_done = 0;

}  // namespace satcheck
