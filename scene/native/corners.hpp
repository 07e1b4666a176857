// Vertices of a format that writes each corner of each facet anew.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

namespace satcheck::scene {

// Corners of the same coordinates, bit for bit, are one vertex; vertices are numbered as they first appear.
// A hash table with linear probing, whose slots can be fetched before they are needed.
template <class Coordinate>
class Corners {
 public:
  using Point = std::array<Coordinate, 3>;

  explicit Corners(std::size_t expected) : slots_(std::bit_ceil(std::max(2 * expected, kFewest))) {}

  static std::uint64_t hash(const Point& point) {
    constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15u;  // 2^64 divided by the golden ratio
    std::uint64_t h = 0;
    for (const Coordinate c : point) {
      h = (h ^ std::bit_cast<Bits>(c)) * kFactor;
      h ^= h >> 29;
    }
    return h;
  }

  void fetch(std::uint64_t hash) const {
#if defined(__GNUC__)
    __builtin_prefetch(&slots_[hash & (slots_.size() - 1)]);
#endif
  }

  // The number of its vertex; where that is new, its coordinates go to the end of `vertices`.
  std::uint32_t number(const Point& point, std::uint64_t hash, std::vector<double>& vertices) {
    Slot& slot = find(point, hash);
    if (slot.number != kEmpty) return slot.number;
    slot = {point, count_};
    for (const Coordinate c : point) vertices.push_back(c);
    if (2 * std::size_t{++count_} > slots_.size()) grow();
    return count_ - 1;
  }

 private:
  using Bits = std::conditional_t<sizeof(Coordinate) == sizeof(std::uint32_t), std::uint32_t, std::uint64_t>;
  static constexpr std::uint32_t kEmpty = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::size_t kFewest = 64;

  struct Slot {
    Point point{};
    std::uint32_t number = kEmpty;
  };

  Slot& find(const Point& point, std::uint64_t hash) {
    std::size_t at = hash & (slots_.size() - 1);
    while (slots_[at].number != kEmpty && std::memcmp(&slots_[at].point, &point, sizeof point) != 0) {
      at = (at + 1) & (slots_.size() - 1);
    }
    return slots_[at];
  }

  void grow() {
    std::vector<Slot> full(2 * slots_.size());
    full.swap(slots_);
    for (const Slot& slot : full) {
      if (slot.number != kEmpty) find(slot.point, hash(slot.point)) = slot;
    }
  }

  std::vector<Slot> slots_;
  std::uint32_t count_ = 0;
};

}  // namespace satcheck::scene
