// The widest edge of two polygons with few corners.
#include "convex/few_edges.hpp"

#include "tests/check.hpp"
#include "tests/convex/polygons.hpp"

using namespace satcheck;
using namespace satcheck::testing;

UNIT(few_edges) {
  const ConvexPolygons apart = pair_of(square(0, 0, 2), square(5, 1, 3));
  const WidestEdge gap = widest_of_few(apart[0], apart[1]);
  CHECK(gap.gap == 3 && gap.of_a && gap.edge == 1 && gap.error < 1e-13);
  const ConvexPolygons within = pair_of(square(0, 0, 10), {{8, 4}, {9, 5}, {8, 6}});
  const WidestEdge deep = widest_of_few(within[0], within[1]);
  CHECK(deep.gap == -2 && deep.of_a && deep.edge == 1 && (deep.corner == 1 || deep.corner == 0));
  CHECK(have_few_corners(apart[0], apart[1]) && !have_few_corners(apart[0], pair_of(ring(9, 0, 0), ring(9, 1, 0))[0]));
}
