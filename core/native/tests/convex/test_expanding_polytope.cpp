// The polytope of EPA, grown to the hull of a few points, against every plane through three of them.
#include <vector>

#include "convex/expanding_polytope.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

// Coordinates are at most 2, a plane through three points of a sphere is off by some roundoffs over their distances.
constexpr double kTolerance = 1e-10;

Simplex simplex_of(const std::vector<Vec3>& points) {
  Simplex s;
  for (std::uint32_t i = 0; i < 4; ++i) s.add({points[i], points[i], i, 0});
  return s;
}

// The least signed distance from the origin, positive within, of a plane through three points that has no point outside.
double least_distance(const std::vector<Vec3>& points) {
  double least = INFINITY;
  for (const Vec3 p : points) {
    for (const Vec3 q : points) {
      for (const Vec3 r : points) {
        const Vec3 n = cross(q - p, r - p);
        if (norm(n) < 1e-9) continue;
        double outside = -INFINITY;
        for (const Vec3 other : points) outside = std::fmax(outside, dot(n, other - p));
        if (outside <= kTolerance * norm(n)) least = std::fmin(least, dot(n, p) / norm(n));
      }
    }
  }
  return least;
}

void test_grows_to_the_hull() {
  testing::Source source(11);
  ExpandingPolytope polytope;
  for (int round = 0; round < 100; ++round) {
    std::vector<Vec3> points = source.sphere_points(4 + round % 16);
    const Vec3 shift = source.in_cube(round % 2 ? 1 : 0.2);  // the origin inside, or anywhere
    for (Vec3& p : points) p = p + shift;
    const Shape hull = make_hull(points), point = make_hull({{0, 0, 0}});
    polytope.clear(MinkowskiDifference(hull, {}, point, {}));
    if (!CHECK(polytope.start(simplex_of(points)))) continue;
    for (std::size_t expansions = 0;; ++expansions) {
      const HalfEdge face = polytope.closest_face();
      const Vec3 normal = polytope.normal(face);
      std::uint32_t farthest = 0;
      for (std::uint32_t i = 1; i < points.size(); ++i) {
        if (dot(normal, points[i]) > dot(normal, points[farthest])) farthest = i;
      }
      const SupportPoint support{points[farthest], points[farthest], farthest, 0};
      if (dot(normal, support.w) - polytope.distance(face) <= kTolerance) {
        CHECK(polytope.contains(support));
        const double truth = least_distance(points);
        CHECK(truth < 0 ? polytope.distance(face) < 0 : std::fabs(polytope.distance(face) - truth) <= kTolerance);
        const double proven = polytope.least_proven_distance(face);
        CHECK(proven <= polytope.distance(face) && proven >= polytope.distance(face) - kTolerance);
        break;
      }
      if (!CHECK(expansions < points.size() && !polytope.contains(support) && polytope.expand(support, face))) break;
    }
  }
}

void test_refuses_a_flat_start() {
  const std::vector<Vec3> square = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, line = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 0, 2}};
  const Shape hull = make_hull(square), point = make_hull({{0, 0, 0}});
  ExpandingPolytope polytope;
  for (const auto& points : {square, line}) {
    polytope.clear(MinkowskiDifference(hull, {}, point, {}));
    CHECK(!polytope.start(simplex_of(points)));
  }
}

}  // namespace

UNIT(expanding_polytope) {
  test_grows_to_the_hull();
  test_refuses_a_flat_start();
}
