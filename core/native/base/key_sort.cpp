// Method: radix sort, least significant digit first: Donald E. Knuth, "The Art of Computer Programming", vol. 3 (1973),
// 5.2.5. Triangles are distributed by their first corner. The few triangles of one corner are then compared.
#include "base/key_sort.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>

#include "base/large_pages.hpp"

namespace satcheck {
namespace {

// Sorts by the lowest `bits` of key(item), one digit at a time, between two buffers. Returns the buffer that holds the
// result.
template <class Item, class Key>
std::span<Item> sort_by_digits(std::span<Item> from, std::span<Item> to, std::size_t bits, Key key) {
  constexpr std::size_t kDigitBits = 11;
  constexpr std::uint64_t kMask = (1 << kDigitBits) - 1;
  const std::size_t digits = (bits + kDigitBits - 1) / kDigitBits;
  const auto digit = [&](const Item& item, std::size_t d) { return key(item) >> d * kDigitBits & kMask; };
  std::vector<std::array<std::uint32_t, kMask + 1>> place(digits);
  for (const Item& item : from) {
    for (std::size_t d = 0; d < digits; ++d) ++place[d][digit(item, d)];
  }
  for (std::size_t d = 0; d < digits; ++d) {
    if (place[d][digit(from[0], d)] == from.size()) continue;
    std::exclusive_scan(place[d].begin(), place[d].end(), place[d].begin(), 0u);
    for (const Item& item : from) to[place[d][digit(item, d)]++] = item;
    std::swap(from, to);
  }
  return from;
}

// Sorts by the coordinates from this axis on; earlier coordinates are equal. Equal points keep their order.
void order_from_axis(std::span<const Vec3> points, int axis, std::span<std::uint32_t> order) {
  const auto compare_all = [&] {
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t k) {
      return points[i] != points[k] ? coordinates_less(points[i], points[k]) : i < k;
    });
  };
  constexpr std::size_t kFewPoints = 64;
  if (order.size() <= kFewPoints) return compare_all();
  double low = INFINITY, high = -INFINITY;
  for (const std::uint32_t i : order) {
    low = smaller(points[i][axis], low);
    high = larger(points[i][axis], high);
  }
  if (!(low < high)) {
    if (axis < 2) order_from_axis(points, axis + 1, order);
    return;
  }
  // Cells of equal width keep the order of the coordinates in spite of rounding. The two ends lie in different cells.
  constexpr double kLastCell = 0xFFFFFFFF;
  const double scale = kLastCell / (high - low);
  if (!(scale > 0 && scale < INFINITY)) return compare_all();
  const auto buffer = unwritten<std::uint64_t>(2 * order.size());
  const std::span<std::uint64_t> cells{buffer.get(), order.size()};
  for (std::size_t i = 0; i < order.size(); ++i) {
    cells[i] = std::uint64_t{static_cast<std::uint32_t>((points[order[i]][axis] - low) * scale)} << 32 | order[i];
  }
  const std::span<std::uint64_t> sorted = sort_by_digits(cells, {buffer.get() + order.size(), order.size()},
                                                              32, [](std::uint64_t cell) { return cell >> 32; });
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(sorted[i]);
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && sorted[last] >> 32 == sorted[first] >> 32) ++last;
    if (last - first > 1) order_from_axis(points, axis, order.subspan(first, last - first));
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
  const auto buffer = unwritten<Keyed>(items.size());
  const std::span<Keyed> sorted =
      sort_by_digits(items, {buffer.get(), items.size()}, 64, [](const Keyed& item) { return item.key; });
  if (sorted.data() != items.data()) std::copy(sorted.begin(), sorted.end(), items.begin());
}

std::vector<std::uint32_t> order_by_coordinates(std::span<const Vec3> points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  if (strictly_ascending(points)) return order;
  order_from_axis(points, 0, order);
  return order;
}

bool strictly_ascending(std::span<const Vec3> points) {
  return std::adjacent_find(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
           return !coordinates_less(a, b);
         }) == points.end();
}

void sort_triangles(std::vector<Triangle>& triangles, std::size_t vertex_count) {
  std::vector<std::uint32_t> end = with_room<std::uint32_t>(vertex_count + 1);  // end of the list of each first corner
  end.resize(vertex_count + 1);
  for (const Triangle& t : triangles) ++end[t[0] + 1];
  std::inclusive_scan(end.begin(), end.end(), end.begin());
  const auto others = unwritten<std::uint64_t>(triangles.size());  // the second and the third corner
  // Each entry starts as the end of the list before it, and grows to the end of its own list.
  for (const Triangle& t : triangles) others[end[t[0]]++] = std::uint64_t{t[1]} << 32 | t[2];
  std::uint32_t start = 0;
  for (std::uint32_t v = 0; v < vertex_count; start = end[v++]) {
    sort_list(others.get() + start, others.get() + end[v]);
    for (std::uint32_t i = start; i < end[v]; ++i) {
      triangles[i] = {v, static_cast<std::uint32_t>(others[i] >> 32), static_cast<std::uint32_t>(others[i])};
    }
  }
}

}  // namespace satcheck
