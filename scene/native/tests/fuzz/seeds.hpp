// The inputs of the folder seeds/, for the unit tests.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace satcheck::scene {

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Calls `use` with each seed and with beginnings of it, each in memory of its own size, so that a sanitizer sees reads
// beyond it. The number of seeds.
template <class Use>
std::size_t run_seeds(Use use) {
  constexpr std::size_t beginnings = 64;
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SATCHECK_SEEDS)) {
    if (!entry.is_regular_file()) continue;
    const std::string seed = bytes_of(entry.path());
    for (std::size_t size = seed.size(), step = size / beginnings + 1;; size -= step) {
      const std::vector<char> copy(seed.begin(), seed.begin() + static_cast<std::ptrdiff_t>(size));
      use(std::string_view(copy.data(), copy.size()));
      if (size < step) break;
    }
    ++count;
  }
  return count;
}

}  // namespace satcheck::scene
