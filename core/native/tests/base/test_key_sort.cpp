// Against std::stable_sort and plain comparison, on few and on many items, and on keys that tie.
#include "base/key_sort.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

void keys() {
  std::mt19937_64 random(1);
  for (const std::size_t count : {0u, 1u, 100u, 5000u}) {
    for (const std::uint64_t mask : {~std::uint64_t{0}, std::uint64_t{0xFF}, std::uint64_t{0xFF} << 40}) {
      std::vector<Keyed> items;
      for (std::uint32_t i = 0; i < count; ++i) items.push_back({random() & mask, i});
      std::vector<Keyed> expected = items;
      std::stable_sort(expected.begin(), expected.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
      sort_by_key(items);
      CHECK(std::equal(items.begin(), items.end(), expected.begin(), expected.end(), [](const Keyed& a, const Keyed& b) {
        return a.key == b.key && a.number == b.number;
      }));
    }
  }
}

void coordinates() {
  std::mt19937 random(2);
  const double values[] = {-2.5, -0.0, 0.0, 1e-300, 3.0, 1e40};  // both zeros are one place
  for (const std::size_t count : {50u, 5000u}) {
    std::vector<Vec3> points(count);
    for (Vec3& p : points) p = {values[random() % 6], values[random() % 6], values[random() % 6]};
    std::vector<std::uint32_t> expected(count);
    std::iota(expected.begin(), expected.end(), 0u);
    std::stable_sort(expected.begin(), expected.end(), [&](std::uint32_t i, std::uint32_t k) {
      return coordinates_less(points[i], points[k]);
    });
    CHECK(order_by_coordinates(points) == expected);
    CHECK(!strictly_ascending(points));
  }
  std::vector<Vec3> crowded;  // ever closer to 0, each in several places
  for (int k = 0; k < 6000; ++k) crowded.push_back({std::ldexp(1.0, -(k % 150)), (k % 7) * 1e-60 - 1e20, std::ldexp(-1.0, k % 90)});
  std::vector<std::uint32_t> expected(crowded.size());
  std::iota(expected.begin(), expected.end(), 0u);
  std::stable_sort(expected.begin(), expected.end(), [&](std::uint32_t i, std::uint32_t k) {
    return coordinates_less(crowded[i], crowded[k]);
  });
  CHECK(order_by_coordinates(crowded) == expected);
  CHECK(strictly_ascending(std::vector<Vec3>{{0, 0, 0}, {0, 0, 1}, {0, 1, -5}}));
  CHECK(!strictly_ascending(std::vector<Vec3>{{0.0, 0, 0}, {-0.0, 0, 0}}));
}

void triangles() {
  std::mt19937 random(3);
  std::vector<Triangle> found(3000);
  for (Triangle& t : found) for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(random() % 90);
  std::vector<Triangle> expected = found;
  std::sort(expected.begin(), expected.end());
  sort_triangles(found, 90);
  CHECK(found == expected);
}

}  // namespace

UNIT(key_sort) {
  keys();
  coordinates();
  triangles();
}
