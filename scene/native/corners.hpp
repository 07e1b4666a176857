// Vertices of a format that repeats the coordinates for each corner of each facet.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "base/large_pages.hpp"

namespace satcheck::scene {

// Corners with equal coordinates, bit for bit, are one vertex. Vertices are numbered in order of first appearance.
// A hash table with linear probing, whose slots can be fetched before they are needed. Its hashes start from a random
// number of the process, because a file could be made of corners whose hashes are all equal. The vertex numbers do not depend on it.
template <class Coordinate>
class Corners {
 public:
  using Point = std::array<Coordinate, 3>;

  // At most a quarter full, because a corner that is not in its first slot costs a mispredicted branch.
  explicit Corners(std::size_t expected)
      : start_(random_number()), size_(std::bit_ceil(std::max(4 * expected, kFewest))), slots_(zeroed<Slot>(size_)) {}

  // Hashes the bytes of a point in place. Reading a copy that was just written with another width would stall.
  std::uint64_t hash(const void* point) const {
    constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15u;  // 2^64 divided by the golden ratio
    std::uint64_t h = start_;
    const auto mix = [&](auto word, std::size_t from) {
      std::memcpy(&word, static_cast<const char*>(point) + from, sizeof word);
      h = (h ^ word) * kFactor;
      h ^= h >> 32;
    };
    std::size_t from = 0;
    for (; from + sizeof(std::uint64_t) <= sizeof(Point); from += sizeof(std::uint64_t)) mix(std::uint64_t{}, from);
    if (from < sizeof(Point)) mix(std::uint32_t{}, from);
    return h;
  }

  void fetch(std::uint64_t hash) const {
#if defined(__GNUC__)
    __builtin_prefetch(&slots_[hash & (size_ - 1)]);
#endif
  }

  // The number of its vertex. The coordinates of a new vertex are appended to `vertices`.
  std::uint32_t number(const Point& point, std::uint64_t hash, std::vector<double>& vertices) {
    Slot& slot = find(point, hash);
    if (slot.behind != kEmpty) return slot.behind - 1;
    slot = {point, ++count_};
    for (const Coordinate c : point) vertices.push_back(c);
    if (2 * std::size_t{count_} > size_) grow();
    return count_ - 1;
  }

 private:
  static constexpr std::uint32_t kEmpty = 0;
  static constexpr std::size_t kFewest = 64;

  struct Slot {
    Point point;
    std::uint32_t behind;  // the number after that of the vertex
  };

  Slot& find(const Point& point, std::uint64_t hash) {
    std::size_t at = hash & (size_ - 1);
    while (slots_[at].behind != kEmpty && std::memcmp(&slots_[at].point, &point, sizeof point) != 0) {
      at = (at + 1) & (size_ - 1);
    }
    return slots_[at];
  }

  void grow() {
    const auto full = std::exchange(slots_, zeroed<Slot>(2 * size_));
    const std::span<const Slot> every(full.get(), std::exchange(size_, 2 * size_));
    for (const Slot& slot : every) {
      if (slot.behind != kEmpty) find(slot.point, hash(&slot.point)) = slot;
    }
  }

  static std::uint64_t random_number() {
    static const std::uint64_t number = [] {
      std::random_device random;
      return std::uint64_t{random()} << 32 | random();
    }();
    return number;
  }

  std::uint64_t start_;
  std::size_t size_;  // a power of two
  std::unique_ptr<Slot[], Free> slots_;
  std::uint32_t count_ = 0;
};

}  // namespace satcheck::scene
