// The results of the rungs of a climb in words: the first stages of the trace of a pair.
#pragma once

#include <string>
#include <vector>

#include "ladder/climb.hpp"

namespace satcheck {

// detail: how the result was found, or why it settles nothing; may be empty.
struct RungWords {
  const char* rung;
  const char* result;
  std::string detail;
  std::int64_t nanoseconds;
};

// The words of the rungs that ran, in their order, without the touch band and the gap. The caller describes these
// together with the request.
std::vector<RungWords> words_of(const Climb& climb);

}  // namespace satcheck
