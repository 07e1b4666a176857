// Planar SAT: intervals, known overlaps, exact contacts, refusals.
#include <stdexcept>

#include "convex/sat_polygon.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

using Polygon = std::vector<Vec2>;

Polygon square(double x, double y, double size) { return {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}}; }

void test_projection() {
  const Projection i = project(square(1, 2, 3), {1, 0});
  CHECK(i.min == 1 && i.max == 4);
}

void test_least_overlap() {
  const PolygonResult r = sat_polygons(square(0, 0, 2), square(1.5, 0.25, 2));
  CHECK(r.outcome == Outcome::penetrating);
  CHECK(r.penetration == 0.5 && r.normal.x == 1 && r.normal.y == 0);
  // A small square inside a big one leaves by the shorter way.
  const PolygonResult inside = sat_polygons(square(1, 4, 1), square(0, 0, 10));
  CHECK(inside.penetration == 2 && inside.normal.x == 1);
  const PolygonResult diamond = sat_polygons({{0, -1}, {1, 0}, {0, 1}, {-1, 0}}, square(0.25, 0.25, 1));
  CHECK(diamond.outcome == Outcome::penetrating);
  CHECK(std::fabs(diamond.penetration - 0.5 / std::sqrt(2.0)) < 1e-15);
}

void test_contacts_are_exact() {
  CHECK(sat_polygons(square(0, 0, 1), square(1, 0.5, 1)).outcome == Outcome::touching);
  CHECK(sat_polygons(square(0, 0, 1), square(1, 1, 1)).outcome == Outcome::touching);
  CHECK(sat_polygons(square(0, 0, 1), square(1 + 0x1p-52, 0, 1)).outcome == Outcome::separated);
  CHECK(sat_polygons(square(0, 0, 1), square(1 - 0x1p-53, 0, 1)).outcome == Outcome::penetrating);
  CHECK(sat_polygons({{0, 0}, {2, 0}, {0, 2}}, square(1, 1, 1)).outcome == Outcome::touching);
}

bool refused(const Polygon& polygon) {
  try {
    sat_polygons(polygon, square(0, 0, 1));
  } catch (const std::invalid_argument&) {
    return true;
  }
  return false;
}

void test_refusals() {
  CHECK(refused({{0, 0}, {1, 0}}));
  CHECK(refused({{0, 0}, {0, 1}, {1, 0}}));                        // clockwise
  CHECK(refused({{0, 0}, {2, 0}, {1, 0.5}, {2, 2}, {0, 2}}));      // a notch
  CHECK(refused({{0, 0}, {1, 0}, {2, 0}}));                        // on one line
  CHECK(refused({{0, 3}, {-2, -3}, {3, 1}, {-3, 1}, {2, -3}}));    // a star
  CHECK(!refused({{0, 0}, {0, 0}, {2, 0}, {2, 2}, {0, 2}}));       // the same corner twice
  CHECK(!refused({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}));       // a corner on a straight edge is fine
}

}  // namespace

UNIT(sat_polygon) {
  test_projection();
  test_least_overlap();
  test_contacts_are_exact();
  test_refusals();
}
