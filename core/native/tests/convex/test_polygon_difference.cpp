// The walk around the Minkowski difference: every edge once, in order, closed.
#include "convex/polygon_difference.hpp"

#include "tests/check.hpp"
#include "tests/convex/polygons.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

void test_the_walk_is_a_convex_polygon(const ConvexPolygons& pair) {
  const ConvexPolygon &a = pair[0], &b = pair[1];
  std::vector<std::pair<Vec2, Vec2>> edges;
  walk_difference(a, b, [&](const DifferenceEdge& e) {
    // An edge of A, seen from B, runs the other way.
    edges.push_back(e.of_a ? std::pair(e.corner - e.from, e.corner - e.to) : std::pair(e.from - e.corner, e.to - e.corner));
    return true;
  });
  CHECK(edges.size() == a.count + b.count);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto [from, to] = edges[k];
    const auto [start, end] = edges[(k + 1) % edges.size()];
    CHECK(to.x == start.x && to.y == start.y);
    CHECK(cross(to - from, end - start) >= 0);
  }
}

void test_gaps_and_signs() {
  const DifferenceEdge e{{0, 0}, {3, 4}, {0.8, -0.6}, {5, 0}, 0, true};
  CHECK(std::fabs(gap_of(e).value - 4) <= gap_of(e).error && sign_of(e, gap_of(e)) == 1);
  const DifferenceEdge on{{0, 0}, {3, 4}, {0.8, -0.6}, {6, 8}, 0, true};
  CHECK(sign_of(on, gap_of(on)) == 0);
}

}  // namespace

UNIT(polygon_difference) {
  // Coordinates of few digits, so that differences are exact.
  test_the_walk_is_a_convex_polygon(pair_of(square(0, 0, 2), square(5, 1, 3)));  // parallel edges
  test_the_walk_is_a_convex_polygon(pair_of(square(0, 0, 2), {{5, 5}, {9, 6}, {7, 9}}));
  test_the_walk_is_a_convex_polygon(pair_of({{0, 0}, {4, 0}, {8, 0}, {8, 8}}, {{1, 1}, {9, 2}, {3, 7}}));
  test_gaps_and_signs();
}
