// Sorting: by keys of few bits without comparisons, and of short lists.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

struct Keyed {
  std::uint64_t key;
  std::uint32_t number;
};

// Sorts in place. Faster than std::sort() for few items, such as most lists around a vertex.
template <class Item>
void sort_list(Item* first, Item* last) {
  constexpr std::ptrdiff_t kFew = 16;
  if (last - first > kFew) {
    std::sort(first, last);
    return;
  }
  for (Item* i = first; i < last; ++i) {
    const Item item = *i;
    Item* at = i;
    for (; at > first && item < at[-1]; --at) *at = at[-1];
    *at = item;
  }
}

// Sorts, and leaves one of equal items.
template <class Item>
void sort_once(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

// Sorts by key; equal keys by number. Items with equal keys must have ascending numbers.
void sort_by_key(std::span<Keyed> items);

// The numbers of the points, sorted by x, then y, then z. Equal points keep their order.
std::vector<std::uint32_t> order_by_coordinates(std::span<const Vec3> points);

// Whether each point comes after the one before it, so that no two are equal.
bool strictly_ascending(std::span<const Vec3> points);

// Sorts in lexicographic order. Every corner is below `vertex_count`.
void sort_triangles(std::vector<Triangle>& triangles, std::size_t vertex_count);

}  // namespace satcheck
