// The head of the input is the mode, the stride, the filter and the count of elements; the stream follows.
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/target.hpp"
#include "readers.hpp"

namespace {

using namespace satcheck::scene;

constexpr std::size_t largest_result = 1 << 24;  // bytes, as a caller limits it

void undo_filters(const std::string& elements) {
  std::string exponents = elements, quaternions = elements;
  undo_exponential_filter(exponents);
  undo_quaternion_filter(quaternions);
  require(exponents.size() == elements.size() && quaternions.size() == elements.size());
}

}  // namespace

FUZZ_TARGET(meshopt) {
  Input input(data);
  const auto mode = static_cast<MeshoptMode>(input.next<std::uint8_t>() % 3);
  const std::size_t stride = input.next<std::uint16_t>(), count = input.next<std::uint32_t>();
  if (stride > 0 && count > largest_result / stride) return;
  try {
    const std::string elements = unpack_meshopt(input.rest(), mode, count, stride);
    require(elements.size() == count * stride);
    undo_filters(elements);
  } catch (const ReadError& error) {
    check(error);
  }
}
