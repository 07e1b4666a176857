// Two convex polygons in a plane: overlap, depth, distance.
#pragma once

#include "convex/convex_polygon.hpp"
#include "convex/narrow_phase.hpp"

namespace satcheck {

// As check_pair(), with z = 0. The outcome is exact. Features: face_a or face_b is the edge that decides, `vertices` are
// two corners. Figures have a relative error of a few roundoffs, however small they are.
PairResult check_polygons(const ConvexPolygon& a, const ConvexPolygon& b, Query query);

}  // namespace satcheck
