#include "motion/balls.hpp"

#include <algorithm>
#include <cmath>

#include "base/rounding.hpp"
#include "mesh/surface.hpp"

namespace satcheck {
namespace {

// Centres of inner balls are tried on a grid with this many cells along the longest side of the body.
constexpr int kCells = 12;
constexpr std::size_t kMostBalls = 48;
// A centre that lies within this share of the radius of a larger ball adds little to that ball.
constexpr double kCovered = 0.5;
// The smallest useful ball, as a share of the longest side.
constexpr double kSmallest = 1.0 / 64;
// So many points are tried on the way inward from a crossing of two triangles, each four times nearer.
constexpr int kMostSharesInward = 5;

std::vector<Ball> candidates(const Surface& surface) {
  const Aabb& box = surface.bvh.nodes[0].box;
  const Vec3 size = box.size();
  const double longest = max_abs(size), step = longest / kCells;
  const double rounding = chain_rounding(box.largest_coordinate());
  const auto cells = [&](double side) { return std::max(1, static_cast<int>(std::ceil(side / step))); };
  const int nx = cells(size.x), ny = cells(size.y), nz = cells(size.z);
  std::vector<Ball> balls;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      for (int k = 0; k < nz; ++k) {
        const Vec3 p = box.min + Vec3{(i + 0.5) * size.x / nx, (j + 0.5) * size.y / ny, (k + 0.5) * size.z / nz};
        const double radius = nearest_point(surface, p).distance - rounding;
        if (radius > kSmallest * longest) balls.push_back({p, radius});
      }
    }
  }
  std::sort(balls.begin(), balls.end(), [](const Ball& p, const Ball& q) {
    return p.radius != q.radius ? p.radius > q.radius : coordinates_less(p.centre, q.centre);
  });
  return balls;
}

}  // namespace

std::vector<Ball> balls_inside(const Surface& closed) {
  std::vector<Ball> chosen;
  if (closed.bvh.nodes.empty()) return chosen;
  for (const Ball& ball : candidates(closed)) {
    const auto covers = [&](const Ball& other) { return norm(ball.centre - other.centre) < kCovered * other.radius; };
    if (std::any_of(chosen.begin(), chosen.end(), covers)) continue;
    if (winding_number(closed, ball.centre).value_or(0) == 0) continue;
    chosen.push_back(ball);
    if (chosen.size() == kMostBalls) break;
  }
  return chosen;
}

bool overlap(const Ball& p, const Ball& q, double depth) {
  const double most = p.radius + q.radius - 2 * depth;
  return p.radius > depth && q.radius > depth &&
         norm_squared(p.centre - q.centre) < most * most * (1 - 16 * kUnitRoundoff);
}

bool any_overlap(const std::vector<Ball>& p, const std::vector<Ball>& q, double depth) {
  return std::any_of(p.begin(), p.end(), [&](const Ball& one) {
    return std::any_of(q.begin(), q.end(), [&](const Ball& other) { return overlap(one, other, depth); });
  });
}

std::optional<ClearBall> clear_ball(const Surface& closed, const PosedPlace& at, Vec3 point, double room) {
  if (closed.bvh.nodes.empty()) return {};
  const Vec3 centre = in_file(at, point);
  const Aabb& box = closed.bvh.nodes[0].box;
  const double largest = larger(max_abs(centre), box.largest_coordinate());
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
