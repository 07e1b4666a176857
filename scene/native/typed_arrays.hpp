// Arrays of the number types that files have, as those that meshes are made of. Little-endian bytes in.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace satcheck::scene {

// float32 numbers; nothing where one is not finite.
std::optional<std::vector<double>> float64_of(std::string_view float32);

struct VertexNumbers {
  std::vector<std::uint32_t> numbers;
  std::uint32_t largest = 0;  // 0 where there are none
};

// Unsigned numbers of `size` bytes: 1, 2 or 4.
VertexNumbers uint32_of(std::string_view unsigned_numbers, std::size_t size);

}  // namespace satcheck::scene
