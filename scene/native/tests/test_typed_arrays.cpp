// Numbers of files as those of meshes: the same values, the largest, and no number that is not finite.
#include "typed_arrays.hpp"

#include <cstdio>
#include <limits>
#include <stdexcept>

namespace {

using namespace satcheck::scene;

int failures = 0;

void check(bool passed, const char* what, int line) {
  if (passed) return;
  ++failures;
  std::fprintf(stderr, "line %d: failed: %s\n", line, what);
}
#define CHECK(expression) check(static_cast<bool>(expression), #expression, __LINE__)

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

void floats() {
  const std::vector<float> values{0.1f, -3.5f, 0.0f, std::numeric_limits<float>::max(), 1e-45f};
  const auto found = float64_of(bytes_of(values));
  CHECK(found && found->size() == values.size());
  for (std::size_t i = 0; i < values.size(); ++i) CHECK((*found)[i] == static_cast<double>(values[i]));
  CHECK(float64_of({})->empty());
  for (const float odd : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    const std::vector<float> with{1.0f, odd, 2.0f};
    CHECK(!float64_of(bytes_of(with)));
  }
}

template <class T>
void unsigned_numbers() {
  const std::vector<T> values{3, std::numeric_limits<T>::max(), 0, 7};
  const VertexNumbers found = uint32_of(bytes_of(values), sizeof(T));
  CHECK((found.numbers == std::vector<std::uint32_t>(values.begin(), values.end())));
  CHECK(found.largest == std::numeric_limits<T>::max());
}

void other_sizes() {
  CHECK(uint32_of({}, 2).largest == 0);
  bool refused = false;
  try {
    uint32_of("abc", 3);
  } catch (const std::invalid_argument&) {
    refused = true;
  }
  CHECK(refused);
}

}  // namespace

int main() {
  floats();
  unsigned_numbers<std::uint8_t>();
  unsigned_numbers<std::uint16_t>();
  unsigned_numbers<std::uint32_t>();
  other_sizes();
  return failures == 0 ? 0 : 1;
}
