// EPA in the plane: the nearest edge of the difference, and a lower bound of the depth.
#include "convex/polygon_epa.hpp"

#include "tests/check.hpp"
#include "tests/convex/polygons.hpp"

using namespace satcheck;
using namespace satcheck::testing;

UNIT(polygon_epa) {
  const ConvexPolygons pair = pair_of(square(0, 0, 2), square(1.5, 0.3, 2));
  const PolygonGjk found = gjk(pair[0], pair[1], {1, 0.4}, false);
  CHECK(found.finding == PolygonFinding::meet);
  const PolygonEpa nearest = epa(pair[0], pair[1], found);
  CHECK(nearest.closed && nearest.least <= 0.5 && nearest.least > 0.5 - 1e-13);
  CHECK(nearest.p.w.x == -0.5 && nearest.q.w.x == -0.5);
}
