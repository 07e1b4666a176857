// Method: least significant digit first, Donald E. Knuth, "The Art of Computer Programming", vol. 3
// (1973), 5.2.5; triangles are distributed by their first corner, which leaves a few at a time to compare.
#include "base/key_sort.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace satcheck {
namespace {

// The order of the numbers as one of bit patterns; -0.0 is 0.0.
std::uint64_t ordered_bits(double coordinate) {
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
  const auto bits = std::bit_cast<std::uint64_t>(coordinate + 0.0);
  return bits & kSign ? ~bits : bits | kSign;
}

void order_by_axis(const std::vector<Vec3>& points, int axis, std::span<Keyed> items) {
  for (Keyed& item : items) item.key = ordered_bits(points[item.number][axis]);
  sort_by_key(items);
  if (axis == 2) return;
  for (std::size_t first = 0, last = 0; first < items.size(); first = last) {
    while (last < items.size() && items[last].key == items[first].key) ++last;
    if (last - first > 1) order_by_axis(points, axis + 1, items.subspan(first, last - first));
  }
}

}  // namespace

void sort_by_key(std::span<Keyed> items) {
  constexpr std::size_t kFewItems = 1024;
  if (items.size() < kFewItems) {
    std::sort(items.begin(), items.end(), [](const Keyed& a, const Keyed& b) {
      return a.key != b.key ? a.key < b.key : a.number < b.number;
    });
    return;
  }
  constexpr std::size_t kDigitBits = 11, kDigits = (64 + kDigitBits - 1) / kDigitBits;
  constexpr std::uint64_t kMask = (1 << kDigitBits) - 1;
  const auto digit = [](const Keyed& item, std::size_t d) { return item.key >> d * kDigitBits & kMask; };
  std::vector<std::array<std::uint32_t, kMask + 1>> place(kDigits);
  for (const Keyed& item : items) {
    for (std::size_t d = 0; d < kDigits; ++d) ++place[d][digit(item, d)];
  }
  std::vector<Keyed> buffer(items.size());
  std::span<Keyed> from = items, to = buffer;
  for (std::size_t d = 0; d < kDigits; ++d) {
    if (place[d][digit(from[0], d)] == items.size()) continue;
    std::exclusive_scan(place[d].begin(), place[d].end(), place[d].begin(), 0u);
    for (const Keyed& item : from) to[place[d][digit(item, d)]++] = item;
    std::swap(from, to);
  }
  if (from.data() != items.data()) std::copy(from.begin(), from.end(), items.begin());
}

std::vector<std::uint32_t> order_by_coordinates(const std::vector<Vec3>& points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  if (strictly_ascending(points)) return order;
  std::vector<Keyed> items(points.size());
  for (const std::uint32_t i : order) items[i].number = i;
  order_by_axis(points, 0, items);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = items[i].number;
  return order;
}

bool strictly_ascending(const std::vector<Vec3>& points) {
  return std::adjacent_find(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
           return !coordinates_less(a, b);
         }) == points.end();
}

void sort_triangles(std::vector<Triangle>& triangles, std::size_t vertex_count) {
  std::vector<std::uint32_t> start(vertex_count + 1, 0);
  for (const Triangle& t : triangles) ++start[t[0] + 1];
  std::inclusive_scan(start.begin(), start.end(), start.begin());
  std::vector<std::uint64_t> others(triangles.size());  // the second and the third corner
  std::vector<std::uint32_t> place(start.begin(), start.end() - 1);
  for (const Triangle& t : triangles) others[place[t[0]]++] = std::uint64_t{t[1]} << 32 | t[2];
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    std::sort(others.begin() + start[v], others.begin() + start[v + 1]);
    for (std::uint32_t i = start[v]; i < start[v + 1]; ++i) {
      triangles[i] = {v, static_cast<std::uint32_t>(others[i] >> 32), static_cast<std::uint32_t>(others[i])};
    }
  }
}

}  // namespace satcheck
