// The thickness of overlaps of known shape.
#include "thickness/thickness_search.hpp"

#include <cmath>

#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

Surface solid_box(Vec3 low, Vec3 high) { return make_surface(box(low, high), true); }

ThicknessInterval search(const Surface& a, const Surface& b, ThicknessGoal goal = {}) {
  goal.work = 20'000'000;
  return search_thickness(a, b, goal);
}

bool holds(const ThicknessInterval& found, double truth) {
  return found.lower <= truth && truth <= found.upper;
}

// A ball and a block around it with a hollow of fewer facets. The search keeps more cells open than it takes at a time.
void threads_change_nothing() {
  Mesh block = box({-2, -2, -2}, {2, 2, 2});
  append(block, reversed(uv_sphere(16)));
  const Surface a = make_surface(uv_sphere(20), true), b = make_surface(block, true);
  ThicknessGoal goal;
  const ThicknessInterval alone = search(a, b, goal);
  CHECK(alone.boxes > 500 && alone.found);
  for (const unsigned threads : {0u, 2u, 5u}) {
    goal.threads = threads;
    const ThicknessInterval found = search(a, b, goal);
    CHECK(found.lower == alone.lower && found.upper == alone.upper && found.centre == alone.centre);
    CHECK(found.boxes == alone.boxes && found.work == alone.work && found.stop == alone.stop);
  }
}

}  // namespace

UNIT(thickness_search) {
  const Surface cube = solid_box({0, 0, 0}, {1, 1, 1}), slab = solid_box({-1, -1, 0.875}, {2, 2, 3});
  const ThicknessInterval overlap = search(cube, slab);
  CHECK(holds(overlap, 0.125) && overlap.stop == SearchStop::narrow);
  CHECK(overlap.found && overlap.radius <= 0.0625 && overlap.radius >= 0.0618);
  CHECK(winding_number(cube, overlap.centre) == 1 && winding_number(slab, overlap.centre) == 1);

  const ThicknessInterval swapped = search(slab, cube);
  CHECK(swapped.lower == overlap.lower && swapped.upper == overlap.upper && swapped.centre == overlap.centre);

  const Surface inner = solid_box({0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}), far = solid_box({2, 2, 2}, {3, 3, 3});
  CHECK(holds(search(cube, inner), 0.25));
  const ThicknessInterval apart = search(cube, far);
  CHECK(!apart.found && apart.lower == 0 && apart.upper == 0 && apart.stop == SearchStop::narrow);

  // Surfaces that may be off: the middle of the slab is 0.0625 deep in both.
  ThicknessGoal less;
  less.less_a = 0.03125;
  less.limit = 0;
  const ThicknessInterval deeper = search(cube, slab, less);
  CHECK(deeper.lower > 0 && deeper.stop == SearchStop::decided);
  less.less_a = 0.15625;
  const ThicknessInterval shallower = search(cube, slab, less);
  CHECK(shallower.upper <= 0 && shallower.stop == SearchStop::decided);

  // Seen along z the prisms overlap by 0.25, and 0.125 is their height.
  const Surface flat = solid_box({0, 0, 0}, {1, 1, 0.125}), beside = solid_box({0.75, -1, 0}, {2, 2, 0.125});
  ThicknessGoal in_plane;
  in_plane.across = 2;
  CHECK(holds(search(flat, beside, in_plane), 0.25));
  CHECK(holds(search(flat, beside), 0.125));

  // Far from the origin, where coordinates are coarse.
  const double away = 1 << 23;
  const Surface far_cube = solid_box({away, 0, away}, {away + 1, 1, away + 1});
  const Surface far_slab = solid_box({away - 1, -1, away + 0.875}, {away + 2, 2, away + 3});
  const ThicknessInterval distant = search(far_cube, far_slab);
  CHECK(holds(distant, 0.125) && distant.stop == SearchStop::narrow);
  CHECK(winding_number(far_cube, distant.centre) == 1 && winding_number(far_slab, distant.centre) == 1);

  threads_change_nothing();
}
