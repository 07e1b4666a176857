#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "readers.hpp"

namespace satcheck::scene {
namespace {

// Calls take(number) for each number.
template <class Number, class Take>
void each(const Rows& rows, Take take) {
  const std::size_t row = rows.columns * sizeof(Number);
  if (rows.stride < row || row == 0) throw std::invalid_argument("rows overlap");
  for (std::size_t start = 0; start + row <= rows.bytes.size(); start += rows.stride) {
    const char* from = rows.bytes.data() + start;
    for (std::size_t k = 0; k < rows.columns; ++k, from += sizeof(Number)) {
      Number number;
      std::memcpy(&number, from, sizeof number);
      take(number);
    }
  }
}

template <class Take>
void each_of_code(const Rows& rows, Take take) {
  switch (rows.code) {
    case 'b': return each<std::int8_t>(rows, take);
    case 'B': return each<std::uint8_t>(rows, take);
    case 'h': return each<std::int16_t>(rows, take);
    case 'H': return each<std::uint16_t>(rows, take);
    case 'I': return each<std::uint32_t>(rows, take);
    case 'f': return each<float>(rows, take);
    default: throw std::invalid_argument("no type of numbers has this code");
  }
}

}  // namespace

std::optional<std::vector<double>> as_numbers(const Rows& rows, double largest) {
  std::vector<double> numbers;
  numbers.reserve(rows.bytes.size() / std::max<std::size_t>(rows.stride, 1) * rows.columns + rows.columns);
  bool finite = true;
  each_of_code(rows, [&](auto number) {
    const double value = static_cast<double>(number);
    finite = finite && std::isfinite(value);
    numbers.push_back(largest == 0 ? value : std::max(value / largest, -1.0));
  });
  if (!finite) return std::nullopt;
  return numbers;
}

std::vector<std::uint32_t> as_indices(const Rows& rows) {
  std::vector<std::uint32_t> indices;
  indices.reserve(rows.bytes.size() / std::max<std::size_t>(rows.stride, 1) * rows.columns + rows.columns);
  each_of_code(rows, [&](auto number) { indices.push_back(static_cast<std::uint32_t>(number)); });
  return indices;
}

}  // namespace satcheck::scene
