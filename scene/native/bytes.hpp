// Numbers in binary files, for any byte order of the file and of the machine.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace satcheck::scene {

template <class T>
T load(const char* from, std::endian order = std::endian::little) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), from, sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace satcheck::scene
