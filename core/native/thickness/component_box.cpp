// The thinnest slab around points has a face of their hull on one side, unless it lies along two edges; of slabs across
// the first axis the second one is the thinnest along a face, too.
#include "thickness/component_box.hpp"

#include <vector>

#include "base/rounding.hpp"
#include "convex/convex_hull.hpp"
#include "thickness/component_balls.hpp"

namespace satcheck {
namespace {

// Corners are rounded twice, a height above a plane takes 3 products and 2 sums of sizes below 3 times the largest
// coordinate. Rounded up.
constexpr double kRoundoffs = 64;

struct Extent {
  double low = INFINITY, high = -INFINITY;
};

Extent extent(const std::vector<Vec3>& points, Vec3 along) {
  Extent result;
  for (const Vec3 p : points) {
    const double height = dot(along, p);
    result.low = smaller(result.low, height);
    result.high = larger(result.high, height);
  }
  return result;
}

// Of the directions, without their part along `across`, the one along which the points extend least.
Vec3 thinnest(const std::vector<Vec3>& points, const std::vector<Vec3>& directions, Vec3 across) {
  Vec3 best;
  double least = INFINITY;
  for (const Vec3 direction : directions) {
    const Vec3 flat = direction - across * dot(across, direction);
    const double length = norm(flat);
    if (!(length > 0.01)) continue;
    const Extent here = extent(points, flat * (1 / length));
    if (!(here.high - here.low < least)) continue;
    least = here.high - here.low;
    best = flat * (1 / length);
  }
  return best;
}

Mat3 axes_of(const std::vector<Vec3>& points) {
  if (points.size() > kMostHullPoints) return {};
  const Polytope hull = convex_hull(points);
  if (hull.dimension < 3) return {};
  const Vec3 first = thinnest(hull.vertices, hull.face_normal, {});
  const Vec3 second = thinnest(hull.vertices, hull.face_normal, first);
  return {{first, second, cross(first, second)}};
}

}  // namespace

BoxAlong box_around(const OverlapComponent& component) {
  BoxAlong box{axes_of(component.corners), {}, {}};
  const double rounding = kRoundoffs * kUnitRoundoff * larger(max_abs(component.bounds.min), max_abs(component.bounds.max));
  Extent of[3];
  for (int axis = 0; axis < 3; ++axis) of[axis] = extent(component.corners, box.axes.row[axis]);
  box.low = Vec3{of[0].low, of[1].low, of[2].low} - Vec3{1, 1, 1} * rounding;
  box.high = Vec3{of[0].high, of[1].high, of[2].high} + Vec3{1, 1, 1} * rounding;
  return box;
}

}  // namespace satcheck
