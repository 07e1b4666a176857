// The map against the scan of all vertices: the same vertex, ties included.
#include "convex/support_map.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

constexpr double kTurn = 6.283185307179586;

// The borders of cells among them: axes, diagonals, and directions a rounding away from those.
std::vector<Vec3> directions(testing::Source& source) {
  std::vector<Vec3> all;
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) {
      for (int z = -4; z <= 4; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vec3 d{x / 4.0, y / 4.0, z / 4.0};
        all.push_back(d);
        all.push_back({std::nextafter(d.x, 9.0), std::nextafter(d.y, -9.0), d.z});
      }
    }
  }
  for (int k = 0; k < 300; ++k) all.push_back(source.on_sphere() * std::pow(10.0, k % 40 - 20));
  return all;
}

void test_finds_what_the_scan_finds(const std::vector<Vec3>& points) {
  testing::Source source(2);
  const SupportMap map(points);
  const VertexLanes lanes(points);
  for (Vec3 d : directions(source)) {
    const CorePoint found = map.support(points, d);
    CHECK(found.index == support_index(lanes, d));
    CHECK(found.point == points[found.index]);
  }
}

void test_random_points() {
  testing::Source source(1);
  for (int count : {1, 2, 7, 8, 9, 40, 64, 128, 500, 3000}) test_finds_what_the_scan_finds(source.sphere_points(count));
}

// All points of a circle compete along its axis; many are in line with others, or the same.
void test_flat_points() {
  std::vector<Vec3> disc, prism, line, grid;
  for (int i = 0; i < 200; ++i) {
    const Vec3 p{std::cos(kTurn * i / 200), std::sin(kTurn * i / 200), 0};
    disc.push_back(p);
    prism.push_back({p.x, p.y, -3});
    prism.push_back({p.x, p.y, 3});
    line.push_back({1, 1, i / 200.0});
    grid.push_back({i % 6 / 5.0, i / 6 % 6 / 5.0, i / 36 / 5.0});
  }
  for (const auto& points : {disc, prism, line, grid, std::vector<Vec3>(100, Vec3{0, 0, 0}), std::vector<Vec3>(100, Vec3{1, 2, 3})}) {
    test_finds_what_the_scan_finds(points);
  }
}

// Vertices a few roundings apart, where the order of two heights is rounding.
void test_near_duplicates() {
  testing::Source source(3);
  for (const Vec3 far : {Vec3{}, Vec3{1, -2, 0.5}}) {
    std::vector<Vec3> points;
    for (Vec3 p : source.sphere_points(60)) {
      p = p + far;
      points.push_back(p);
      points.push_back({std::nextafter(p.x, 9.0), p.y, p.z});
      points.push_back({p.x, std::nextafter(p.y, -9.0), std::nextafter(p.z, 9.0)});
    }
    test_finds_what_the_scan_finds(points);
  }
}

void test_scale_and_proportions() {
  testing::Source source(4);
  for (const Vec3 size : {Vec3{1e-40, 1e-40, 1e-40}, Vec3{1e40, 1e40, 1e40}, Vec3{1, 1e-6, 1e-12}, Vec3{1e-9, 1, 1}}) {
    std::vector<Vec3> points = source.sphere_points(150);
    for (Vec3& p : points) p = {p.x * size.x, p.y * size.y, p.z * size.z};
    test_finds_what_the_scan_finds(points);
  }
}

void test_no_direction() {
  testing::Source source(5);
  const std::vector<Vec3> points = source.sphere_points(100);
  const CorePoint found = SupportMap(points).support(points, {0, 0, 0});
  CHECK(found.index < points.size());
}

void test_is_made_once_for_all_copies() {
  testing::Source source(6);
  const std::vector<Vec3> few = source.sphere_points(12), many = source.sphere_points(200);
  const LazySupportMap never(few.size()), map(many.size()), copy = map;
  CHECK(map.for_query(many) == nullptr);
  const SupportMap* made = nullptr;
  for (int i = 0; i < 1000 && !made; ++i) made = copy.for_query(many);
  CHECK(made != nullptr);
  CHECK(map.for_query(many) == made);
  for (int i = 0; i < 1000; ++i) CHECK(never.for_query(few) == nullptr);
}

}  // namespace

UNIT(support_map) {
  test_random_points();
  test_flat_points();
  test_near_duplicates();
  test_scale_and_proportions();
  test_no_direction();
  test_is_made_once_for_all_copies();
}
