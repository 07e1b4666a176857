// What the rungs of a climb found, in words: the first stages of the trace of a pair.
#pragma once

#include <string>
#include <vector>

#include "scene/climb.hpp"

namespace satcheck {

// detail: how it was found, or why it settles nothing; may be empty.
struct RungWords {
  const char* rung;
  const char* result;
  std::string detail;
  std::int64_t nanoseconds;
};

// Of the rungs that ran, in their order. Those of the touch band and of the gap are not among them: what they found is
// put into words with what was asked.
std::vector<RungWords> words_of(const Climb& climb);

}  // namespace satcheck
