// The centre of the largest ball in a polytope is that of Chebyshev's linear programme. Over a box that holds the
// polytope it is a game of the corners of the box against the planes of the polytope, to which planes are added while
// one is nearer than the value of the game: James E. Kelley, "The Cutting-Plane Method for Solving Convex Programs"
// (1960).
#include "thickness/component_search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/numeric_range.hpp"
#include "base/rounding.hpp"
#include "convex/convex_hull.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "thickness/cell.hpp"
#include "thickness/matrix_game.hpp"

namespace satcheck {
namespace {

// A height over a plane takes 12 roundings of products below 6 times the largest coordinate, those of a weighted sum
// as many again, and a distance from a triangle up to 120 of it. Rounded up.
constexpr double kHeightRoundoffs = 256;

// Planes that meet in one corner of a polytope and count are few; more rounds only repeat rounding.
constexpr int kMostRounds = 100;

Vec3 corner(const Aabb& box, std::size_t k) {
  return {k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z};
}

struct Plane {
  Vec3 normal;
  double height;  // all of the polytope is at or behind it

  double depth(Vec3 p) const { return height - dot(normal, p); }
};

std::vector<Plane> box_planes(const std::vector<Vec3>& points) {
  const Aabb box = bounds_of(points);
  return {{{1, 0, 0}, box.max.x}, {{0, 1, 0}, box.max.y}, {{0, 0, 1}, box.max.z},
          {{-1, 0, 0}, -box.min.x}, {{0, -1, 0}, -box.min.y}, {{0, 0, -1}, -box.min.z}};
}

// Nothing of points in one plane, or below the range. Of many points, the sides of their box.
std::vector<Plane> hull_planes(const std::vector<Vec3>& points) {
  if (!are_in_range(points)) return {};
  if (points.size() > kMostHullPoints) return box_planes(points);
  const Polytope polytope = convex_hull(points);
  std::vector<Plane> planes;
  if (polytope.dimension < 3) return planes;
  for (const Vec3 normal : polytope.face_normal) {
    Plane& plane = planes.emplace_back(Plane{normal, -INFINITY});
    for (const Vec3 p : polytope.vertices) plane.height = larger(plane.height, dot(normal, p));
  }
  return planes;
}

struct InnerBall {
  Vec3 centre;
  double radius;  // no ball in the polytope has a larger one, but for rounding
};

InnerBall largest_ball(const std::vector<Plane>& planes, const Aabb& box) {
  const Vec3 size = box.size();
  MatrixGame game(8, -2 * norm(size));
  std::vector<double> payments;  // 8 a plane
  std::vector<std::size_t> chosen;
  InnerBall ball{box.centre(), smaller(size.x, smaller(size.y, size.z)) / 2};
  for (int round = 0; round < kMostRounds; ++round) {
    const auto nearest = std::min_element(planes.begin(), planes.end(), [&](const Plane& p, const Plane& q) {
      return p.depth(ball.centre) < q.depth(ball.centre);
    });
    const auto number = static_cast<std::size_t>(nearest - planes.begin());
    if (std::find(chosen.begin(), chosen.end(), number) != chosen.end()) break;
    chosen.push_back(number);
    for (std::size_t k = 0; k < 8; ++k) payments.push_back(nearest->depth(corner(box, k)));
    game.add({payments.data() + payments.size() - 8, 8});
    game.solve();
    ball.centre = {};
    double total = 0, most = -INFINITY;
    for (const double weight : game.column_weights()) total += weight;
    for (std::size_t k = 0; k < 8; ++k) {
      ball.centre = ball.centre + corner(box, k) * game.row_weights()[k];
      double sum = 0;
      for (std::size_t c = 0; c < chosen.size(); ++c) sum += game.column_weights()[c] * payments[8 * c + k];
      most = larger(most, sum / total);
    }
    ball.radius = smaller(ball.radius, most);
  }
  return ball;
}

bool is_inside(const Surface& solid, Vec3 p) {
  const auto winding = winding_number(solid, p);
  return winding && *winding != 0;
}

// Corners are rounded twice, a height above a plane takes 3 products and 2 sums of sizes below 3 times the largest
// coordinate. Rounded up.
constexpr double kRoundoffs = 64;

Range range_of(const std::vector<Vec3>& points, Vec3 along) {
  Range range;
  for (const Vec3 p : points) range.include(dot(along, p));
  return range;
}

// Of the directions, without their part along `across`, the one along which the points extend least.
Vec3 thinnest(const std::vector<Vec3>& points, const std::vector<Vec3>& directions, Vec3 across) {
  Vec3 best;
  double least = INFINITY;
  for (const Vec3 direction : directions) {
    const Vec3 flat = direction - across * dot(across, direction);
    const double length = norm(flat);
    if (!(length > 0.01)) continue;
    const double here = range_of(points, flat * (1 / length)).width();
    if (!(here < least)) continue;
    least = here;
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

// Of triangles that meet; more take longer than they are worth.
constexpr std::size_t kMostPairs = 100'000;

// A hull that is thicker than all of the overlap by this factor says nothing about its component.
constexpr double kThicker = 2;

// Of 2 min(d_A - e_A, d_B - e_B) in a component; rounded up.
double hull_bound(const ThicknessInterval& ball, const ThicknessGoal& goal) {
  return std::nextafter(ball.upper - 2 * std::fmin(goal.less_a, goal.less_b), INFINITY);
}

}  // namespace

std::vector<ThicknessInterval> component_balls(const Surface& a, const Surface& b, const OverlapComponents& overlap) {
  const std::vector<OverlapComponent>& components = overlap.components;
  std::vector<std::vector<Plane>> hulls;
  for (const OverlapComponent& component : components) hulls.push_back(hull_planes(component.corners));
  std::vector<ThicknessInterval> intervals;
  for (std::size_t k = 0; k < components.size(); ++k) {
    const Aabb& box = components[k].bounds;
    const double rounding = kHeightRoundoffs * kUnitRoundoff * box.largest_coordinate();
    ThicknessInterval& interval = intervals.emplace_back();
    interval.stop = SearchStop::work_spent;
    interval.upper = 2 * rounding;
    if (const Vec3 size = box.size(); max_abs(size) < kSmallestSize) {
      interval.upper += smaller(size.x, smaller(size.y, size.z));
    }
    if (hulls[k].empty()) continue;
    const InnerBall ball = largest_ball(hulls[k], box);
    interval.upper = 2 * (larger(ball.radius, 0) + rounding);
    const auto in_other_hull = [&](std::size_t other) {
      const auto beyond = [&](const Plane& plane) { return plane.depth(ball.centre) < -rounding; };
      return other != k && components[other].bounds.contains({ball.centre, ball.centre}) &&
             std::none_of(hulls[other].begin(), hulls[other].end(), beyond);
    };
    bool own = overlap.resolved && is_inside(a, ball.centre) && is_inside(b, ball.centre);
    for (std::size_t other = 0; other < components.size() && own; ++other) own = !in_other_hull(other);
    if (!own) continue;
    const double near = smaller(nearest_point(a, ball.centre).distance, nearest_point(b, ball.centre).distance);
    interval.centre = ball.centre;
    interval.found = near > rounding;
    interval.radius = larger(near - rounding, 0);
    interval.lower = 2 * interval.radius;
  }
  return intervals;
}

// The thinnest slab around points has a face of their hull on one side, unless it lies along two edges; of slabs across
// the first axis the second one is the thinnest along a face, too.
BoxAlong box_around(const OverlapComponent& component) {
  BoxAlong box{axes_of(component.corners), {}, {}};
  const double rounding = kRoundoffs * kUnitRoundoff * component.bounds.largest_coordinate();
  Range of[3];
  for (int axis = 0; axis < 3; ++axis) of[axis] = range_of(component.corners, box.axes.row[axis]);
  box.low = Vec3{of[0].low, of[1].low, of[2].low} - Vec3{1, 1, 1} * rounding;
  box.high = Vec3{of[0].high, of[1].high, of[2].high} + Vec3{1, 1, 1} * rounding;
  return box;
}

ComponentSearch::ComponentSearch(const Surface& a, const Surface& b, const ThicknessGoal& goal, const ThicknessInterval& known)
    : goal_(goal), budget_(goal.work, goal.poll) {
  budget_.note(known.lower, known.upper);
  Budget of_pair = budget_in_search(a.mesh, b.mesh, [this](const SearchState& state) { budget_.tell_again(state.work); });
  overlap_ = overlap_components(a, b, kMostPairs, Unresolved::left_out, &of_pair);
  if (!resolved()) return;
  balls_ = component_balls(a, b, overlap_);
  for (const ThicknessInterval& ball : balls_) upper_.push_back(hull_bound(ball, goal));
}

ThicknessInterval ComponentSearch::bound(const ThicknessInterval& known) {
  best_ = known;
  for (const ThicknessInterval& ball : balls_) take_ball(ball);
  double upper = best_.lower;
  for (const double of_one : upper_) upper = std::fmax(upper, of_one);
  best_.upper = std::fmax(std::fmin(known.upper, upper), best_.lower);
  return best_;
}

bool ComponentSearch::are_thick(const ThicknessInterval& known) const {
  const auto is_thick = [&](double upper) { return upper > kThicker * known.upper; };
  const auto thick = static_cast<std::uint64_t>(std::count_if(upper_.begin(), upper_.end(), is_thick));
  return thick * known.work > goal_.work - std::min(goal_.work, known.work);
}

ThicknessInterval ComponentSearch::search(const ThicknessInterval& known, const SearchWithin& within) {
  bound(known);
  budget_.spend(known.work);
  narrow(within, [&](std::size_t open) { return budget_.left() / open; });
  narrow(within, [&](std::size_t) { return budget_.left(); });
  return bound(best_);
}

void ComponentSearch::take_ball(const ThicknessInterval& ball) {
  ThicknessInterval less = ball;
  less.lower = std::nextafter(2 * (ball.radius - std::fmax(goal_.less_a, goal_.less_b)), -INFINITY);
  if (ball.found) take_point(less);
}

void ComponentSearch::take_point(const ThicknessInterval& other) {
  if (!(other.lower > best_.lower)) return;
  best_.lower = other.lower;
  best_.found = other.found;
  best_.centre = other.centre;
  best_.radius = other.radius;
}

// A component with a bound no larger is not searched.
double ComponentSearch::enough() const {
  const double narrow = best_.lower > 0 ? best_.lower / (1 - goal_.width) : best_.lower;
  return goal_.limit ? std::fmax(narrow, *goal_.limit) : narrow;
}

// All components that leave the goal open, the thickest first. share: of the work, by how many they are.
template <class Share>
void ComponentSearch::narrow(const SearchWithin& within, Share share) {
  std::vector<std::size_t> open;
  for (std::size_t k = 0; k < upper_.size(); ++k) {
    if (upper_[k] > enough()) open.push_back(k);
  }
  std::stable_sort(open.begin(), open.end(), [&](auto p, auto q) { return upper_[p] > upper_[q]; });
  for (std::size_t i = 0; i < open.size() && !budget_.is_spent(); ++i) {
    double& upper = upper_[open[i]];
    if (upper <= enough()) break;  // and so are those after it
    share_ = share(open.size() - i);
    upper = std::fmin(upper, upper_end(open[i], within));
  }
}

// Proven, of a component that is searched.
double ComponentSearch::upper_end(std::size_t component, const SearchWithin& within) {
  ThicknessGoal goal = goal_;
  goal.within = box_around(overlap_.components[component]);
  goal.limit = enough();
  ThicknessInterval interval = searched(goal, within);
  if (!goal_.limit && interval.lower > *goal.limit && share_ > 0) {
    goal.limit.reset();
    interval = searched(goal, within);
  }
  return interval.upper;
}

ThicknessInterval ComponentSearch::searched(ThicknessGoal& goal, const SearchWithin& within) {
  goal.work = share_;
  if (goal_.poll) goal.poll = [this](const SearchState& of_one) { goal_.poll({best_.lower, best_.upper, best_.work + of_one.work}); };
  const ThicknessInterval interval = within(goal);
  budget_.spend(interval.work);
  share_ -= std::min(share_, interval.work);
  best_.work += interval.work;
  best_.boxes += interval.boxes;
  if (budget_.is_due()) budget_.tell(best_.lower, best_.upper);
  if (interval.found) take_point(interval);
  return interval;
}

}  // namespace satcheck
