// Sets of convex polygons: extremes, normals, refusals.
#include "convex/convex_polygon.hpp"

#include <stdexcept>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

using Corners = std::vector<Vec2>;

ConvexPolygons one(const Corners& corners) { return {corners, {0, static_cast<std::uint32_t>(corners.size())}}; }

void test_extremes_and_normals() {
  const ConvexPolygons polygons({{9, 9}, {10, 9}, {9, 10}, {2, 3}, {0, 3}, {0, 1}, {2, 1}}, {0, 3, 7});
  CHECK(polygons.size() == 2);
  const ConvexPolygon& p = polygons[1];
  CHECK(p.count == 4 && p.lowest == 2 && p.highest == 0);
  CHECK(p.low.x == 0 && p.low.y == 1 && p.high.x == 2 && p.high.y == 3);
  CHECK(p.normals[0].x == 0 && p.normals[0].y == 1);
  CHECK(p.normals[3].x == 1 && p.normals[3].y == 0);
}

void test_normals_of_tiny_edges() {
  const double tiny = 0x1p-1070;  // 16 times the smallest float64
  const ConvexPolygons polygons = one({{0, 0}, {3 * tiny, -4 * tiny}, {1, 0}, {0, 1}});
  CHECK(std::fabs(polygons[0].normals[0].x + 0.8) < 1e-15 && std::fabs(polygons[0].normals[0].y + 0.6) < 1e-15);
}

template <class Refusal>
bool refused(const Corners& corners) {
  try {
    one(corners);
  } catch (const Refusal&) {
    return true;
  }
  return false;
}

void test_refusals() {
  using Wrong = std::invalid_argument;
  CHECK(refused<Wrong>({{0, 0}, {1, 0}}));
  CHECK(refused<Wrong>({{0, 0}, {0, 1}, {1, 0}}));                    // clockwise
  CHECK(refused<Wrong>({{0, 0}, {2, 0}, {1, 0.5}, {2, 2}, {0, 2}}));  // a notch
  CHECK(refused<Wrong>({{0, 0}, {1, 0}, {2, 0}}));                    // on one line
  CHECK(refused<Wrong>({{0, 0}, {1, 0}, {1, 0}, {0, 1}}));            // a corner twice
  CHECK(refused<Wrong>({{0, 3}, {-2, -2}, {3, 1}, {-3, 1}, {2, -2}}));  // a star with five points, in one line
  CHECK(refused<Wrong>({{0, 0}, {1, 0}, {0, NAN}}));
  CHECK(refused<std::overflow_error>({{0, 0}, {1e46, 0}, {0, 1}}));
  CHECK(refused<std::overflow_error>({{0, 0}, {1e-46, 0}, {0, 1e-46}}));
  CHECK(!refused<Wrong>({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}));  // a corner on a straight edge is fine
}

void test_starts_that_do_not_fit() {
  for (const std::vector<std::uint32_t>& starts : {std::vector<std::uint32_t>{}, {0}, {0, 2}, {1, 3}, {0, 9, 3}}) {
    bool thrown = false;
    try {
      ConvexPolygons({{0, 0}, {1, 0}, {0, 1}}, starts);
    } catch (const std::invalid_argument&) {
      thrown = true;
    }
    CHECK(thrown);
  }
}

}  // namespace

UNIT(convex_polygon) {
  test_extremes_and_normals();
  test_normals_of_tiny_edges();
  test_refusals();
  test_starts_that_do_not_fit();
}
