// Functions that all readers share: errors, and numbers in binary files.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "read_result.hpp"

namespace satcheck::scene {

// Readers stop by throwing a ReadError. `run_reader` catches it and returns it as the outcome.
[[noreturn]] inline void fail_at_line(const char* code, std::string message, std::int64_t line) {
  throw ReadError{code, std::move(message), line, nowhere};
}
[[noreturn]] inline void fail_at_byte(const char* code, std::string message, std::int64_t offset) {
  throw ReadError{code, std::move(message), nowhere, offset};
}
[[noreturn]] inline void fail(const char* code, std::string message) {
  throw ReadError{code, std::move(message), nowhere, nowhere};
}

template <class Reader>
ReadOutcome run_reader(Reader reader) {
  try {
    return reader();
  } catch (ReadError& error) {
    return std::move(error);
  }
}

// Vertex numbers are stored in 32 bits.
constexpr std::int64_t max_vertices = std::numeric_limits<std::uint32_t>::max();

// A number in a file, for any byte order of the file and of the machine.
template <class T>
T load(const char* from, std::endian order = std::endian::little) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), from, sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace satcheck::scene
