// GJK in the plane: proofs, and the features at the end of the search.
#include "convex/polygon_gjk.hpp"

#include "tests/check.hpp"
#include "tests/convex/polygons.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

PolygonGjk search(const Corners& a, const Corners& b) {
  const ConvexPolygons pair = pair_of(a, b);
  return gjk(pair[0], pair[1], {1, 0.3}, true);
}

void test_findings() {
  for (const std::uint32_t count : {4u, 9u, 100u}) {
    CHECK(search(ring(count, 0, 0), ring(count, 3, 1)).finding == PolygonFinding::apart);
    CHECK(search(ring(count, 0, 0), ring(count, 1, 0.5)).finding == PolygonFinding::meet);
  }
  CHECK(search(square(0, 0, 1), square(1, 0, 1)).finding == PolygonFinding::open);
}

void test_the_nearest_corner() {
  const PolygonGjk found = search(square(0, 0, 1), square(4, 5, 1));
  CHECK(found.count == 1 && found.simplex[0].i == 2 && found.simplex[0].j == 0);
}

void test_the_nearest_point_of_a_segment() {
  const OriginNearest inner = nearest_to_origin({-1, 2}, {1, 2}), end = nearest_to_origin({1, 2}, {3, 2});
  CHECK(inner.inner && inner.v.x == 0 && inner.v.y == 2 && inner.squared == 4);
  CHECK(!end.inner && end.v.x == 1 && end.squared == 5);
}

}  // namespace

UNIT(polygon_gjk) {
  test_findings();
  test_the_nearest_corner();
  test_the_nearest_point_of_a_segment();
}
