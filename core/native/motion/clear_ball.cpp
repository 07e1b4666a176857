#include "motion/clear_ball.hpp"

#include <algorithm>

#include "base/rounding.hpp"
#include "mesh/nearest_point.hpp"

namespace satcheck {
namespace {

// So many points are tried on the way inward from a crossing of two triangles, each four times nearer.
constexpr int kMostSharesInward = 5;

}  // namespace

std::optional<ClearBall> clear_ball(const Surface& closed, const PosedPlace& at, Vec3 point, double room) {
  if (closed.bvh.nodes.empty()) return {};
  const Vec3 centre = in_file(at, point);
  const Aabb& box = closed.bvh.nodes[0].box;
  const double largest = std::max({max_abs(centre), max_abs(box.min), max_abs(box.max)});
  const Ball ball = in_world(at, Ball{centre, nearest_point(closed, centre).distance - chain_rounding(largest)});
  if (!(ball.radius > room)) return {};
  const auto winding = winding_number(closed, centre);
  return winding ? std::optional(ClearBall{ball, *winding != 0}) : std::nullopt;
}

bool ball_beside(const CommonSegment& crossing, const Surface& a, const PosedPlace& at_a, const Surface& b,
                 const PosedPlace& at_b, double depth) {
  double share = 1;
  for (int step = 0; step < kMostSharesInward; ++step, share *= 0.25) {
    const Vec3 point = crossing.middle + crossing.inward * share;
    const auto in_a = clear_ball(a, at_a, point, depth), in_b = clear_ball(b, at_b, point, depth);
    if (in_a && in_b && in_a->inside && in_b->inside && overlap(in_a->ball, in_b->ball, depth)) return true;
  }
  return false;
}

bool is_clear(const Surface& closed, const PosedPlace& at, Vec3 point, double room, bool inside) {
  const auto clear = clear_ball(closed, at, point, room);
  return clear && clear->inside == inside && norm(point - clear->ball.centre) + room < clear->ball.radius;
}

}  // namespace satcheck
