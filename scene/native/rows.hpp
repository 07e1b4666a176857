// Rows of numbers in a buffer, as accessors of glTF lay them out: little-endian, a stride apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace satcheck::scene {

// bytes: from the first number on. code: of the type of the numbers, as in Python's `array`: b B h H I f. columns: numbers
// a row. stride: bytes from row to row, at least those of a row; the last row ends with the bytes.
struct Rows {
  std::string_view bytes;
  char code;
  std::size_t columns;
  std::size_t stride;
};

// All numbers, divided by `largest` and not below -1 unless it is 0; nothing if one is not finite.
std::optional<std::vector<double>> as_numbers(const Rows& rows, double largest);

// All numbers, which are unsigned integers.
std::vector<std::uint32_t> as_indices(const Rows& rows);

}  // namespace satcheck::scene
