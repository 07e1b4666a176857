// Numbers and text from the bytes of a fuzzer. A number that is no longer there is zero.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace satcheck::scene {

class Input {
 public:
  explicit Input(std::string_view data) : rest_(data) {}

  template <class T>
  T next() {
    T value{};
    const std::size_t size = std::min(sizeof value, rest_.size());
    if (size > 0) std::memcpy(&value, rest_.data(), size);
    rest_.remove_prefix(size);
    return value;
  }

  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

}  // namespace satcheck::scene
