// What queries on this thread have cost so far, in steps of about a nanosecond: counted where the work is done, in
// exact arithmetic too, and not by a clock. The same input counts the same on every machine.
#pragma once

#include <cstdint>

namespace satcheck {

inline constinit thread_local std::uint64_t work_done = 0;

}  // namespace satcheck
