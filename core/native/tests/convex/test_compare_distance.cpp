// Distances that are exact squares, and all that is one ulp beside them.
#include "convex/convex_hull.hpp"
#include "convex/exact_distance.hpp"

#include <cmath>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

const Polytope cube = convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}});

Polytope point(double x, double y, double z) { return convex_hull({{x, y, z}}); }

int compared(const Polytope& a, const Polytope& b, const Dyadic& length) {
  return compare_distance(ExactDifference(a.vertices, b.vertices), length);
}

// Both orders, at the distance and one ulp to either side; the length is split unevenly over the two.
void expect(const Polytope& a, const Polytope& b, double distance) {
  for (const double share : {0.0, 0.25}) {
    const double rest = distance - share;
    const auto length = [&](double other) { return Dyadic(share) + Dyadic(other); };
    for (const auto& [one, other] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
      CHECK(compared(*one, *other, length(rest)) == 0);
      CHECK(compared(*one, *other, length(std::nextafter(rest, 0.0))) == 1);
      CHECK(compared(*one, *other, length(std::nextafter(rest, INFINITY))) == -1);
    }
  }
}

void vertices_edges_and_faces() {
  expect(cube, point(0.5, 0.25, 3), 2);                                   // over a face
  expect(cube, point(0.5, 4, 5), 5);                                      // over an edge
  expect(cube, point(2, 3, 3), 3);                                        // off a corner
  expect(point(0, 0, 0), point(2, 3, 6), 7);                              // two points
  expect(convex_hull({{-1, 0, 0}, {1, 0, 0}}), point(0.3, 3, 4), 5);      // a segment
  expect(convex_hull({{9, 0, 0}, {1, 4, 0}, {-3, 1, 5}}), point(0, 0, 0), 3);  // a slanted triangle
}

void edges() {
  expect(convex_hull({{-1, 0, 0}, {1, 0, 0}}), convex_hull({{0, -1, 2}, {0.5, 1, 2}}), 2);  // crossed
  expect(convex_hull({{-1, 0, 0}, {1, 0, 0}}), convex_hull({{-3, 3, 4}, {9, 3, 4}}), 5);    // parallel
  expect(convex_hull({{-1, 0, 0}, {1, 0, 0}}), convex_hull({{3, 0, 0}, {9, 0, 0}}), 2);     // in one line
  // An edge of the cube, x + z = 2, and a slanted one in the plane x + z = 5: the distance is no float64, so
  // only the side is asked.
  const Polytope slanted = convex_hull({{4, -1, 1}, {1, 2, 4}});
  const double distance = std::sqrt(4.5);
  CHECK(compared(cube, slanted, distance * (1 + 1e-15)) == -1);
  CHECK(compared(cube, slanted, distance * (1 - 1e-15)) == 1);
}

void far_and_small() {
  const double tiny = 0x1p-140;
  expect(point(0x1p60, 0, 0), point(0x1p60 + 0x1p10, 0, 0), 0x1p10);
  CHECK(compared(point(0, 0, 0), point(3 * tiny, 4 * tiny, 0), 5 * tiny) == 0);
  CHECK(compared(point(0, 0, 0), point(1, 0, 0), Dyadic(1) + Dyadic(tiny)) == -1);
}

// Hulls that meet, at a point, along a face, or with a common interior, have the distance 0.
void hulls_that_meet() {
  for (const Polytope& other : {point(1, 1, 1), point(0.5, 0.5, 0.5), convex_hull({{2, 0, 0}, {1, 0.5, 0.5}, {2, 2, 0}}), cube}) {
    for (const auto& [one, two] : {std::pair{&cube, &other}, std::pair{&other, &cube}}) {
      CHECK(compared(*one, *two, -1) == 1);
      CHECK(compared(*one, *two, 0) == 0);
      CHECK(compared(*one, *two, 0x1p-140) == -1);
    }
  }
}

}  // namespace

UNIT(compare_distance) {
  vertices_edges_and_faces();
  edges();
  far_and_small();
  hulls_that_meet();
}
