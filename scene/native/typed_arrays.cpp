#include "typed_arrays.hpp"

#include <cmath>
#include <stdexcept>

#include "bytes.hpp"

namespace satcheck::scene {
namespace {

template <class T>
VertexNumbers widened(std::string_view bytes) {
  VertexNumbers found;
  found.numbers.reserve(bytes.size() / sizeof(T));
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    const std::uint32_t number = load<T>(bytes.data() + at);
    found.numbers.push_back(number);
    found.largest = std::max(found.largest, number);
  }
  return found;
}

}  // namespace

std::optional<std::vector<double>> float64_of(std::string_view float32) {
  std::vector<double> found;
  found.reserve(float32.size() / sizeof(float));
  bool finite = true;
  for (std::size_t at = 0; at + sizeof(float) <= float32.size(); at += sizeof(float)) {
    found.push_back(load<float>(float32.data() + at));
    finite = finite && std::isfinite(found.back());
  }
  return finite ? std::optional(std::move(found)) : std::nullopt;
}

VertexNumbers uint32_of(std::string_view unsigned_numbers, std::size_t size) {
  switch (size) {
    case 1: return widened<std::uint8_t>(unsigned_numbers);
    case 2: return widened<std::uint16_t>(unsigned_numbers);
    case 4: return widened<std::uint32_t>(unsigned_numbers);
    default: throw std::invalid_argument("numbers of 1, 2 or 4 bytes");
  }
}

}  // namespace satcheck::scene
