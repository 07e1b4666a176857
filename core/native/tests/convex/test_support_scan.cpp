// The lane-parallel scan against a plain loop, ties and padding included.
#include "convex/support_scan.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

std::uint32_t plain(const std::vector<Vec3>& points, Vec3 d) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 1; i < points.size(); ++i) {
    const Vec3 p = points[i], q = points[best];
    if (p.x * d.x + p.y * d.y + p.z * d.z > q.x * d.x + q.y * d.y + q.z * d.z) best = i;
  }
  return best;
}

void test_random_scans() {
  testing::Source source(1);
  for (int count = 1; count <= 70; ++count) {
    const std::vector<Vec3> points = source.sphere_points(count);
    const VertexLanes lanes(points);
    for (int k = 0; k < 20; ++k) {
      const Vec3 d = source.on_sphere();
      CHECK(support_index(lanes, d) == plain(points, d));
    }
  }
}

void test_ties_take_the_first() {
  const std::vector<Vec3> points(21, Vec3{1, 2, 3});
  CHECK(support_index(VertexLanes(points), {1, 1, 1}) == 0);
  std::vector<Vec3> corners;
  for (int i = 0; i < 16; ++i) corners.push_back({i % 2 ? 1.0 : -1.0, 0, 0});
  CHECK(support_index(VertexLanes(corners), {1, 0, 0}) == 1);
}

}  // namespace

UNIT(support_scan) {
  test_random_scans();
  test_ties_take_the_first();
}
