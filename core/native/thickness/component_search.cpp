#include "thickness/component_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "thickness/component_balls.hpp"
#include "thickness/component_box.hpp"

namespace satcheck {
namespace {

// Of triangles that meet; more take longer than they are worth.
constexpr std::size_t kMostPairs = 100'000;

class ComponentSearch {
 public:
  ComponentSearch(const OverlapComponents& overlap, std::vector<ThicknessInterval> balls, const ThicknessGoal& goal,
                  const ThicknessInterval& known, const SearchWithin& search)
      : overlap_(overlap), balls_(std::move(balls)), goal_(goal), best_(known), search_(search), left_(goal.work) {}

  ThicknessInterval run() {
    const double known = best_.upper;
    for (const ThicknessInterval& ball : balls_) take_ball(ball);
    double upper = best_.lower;
    for (const std::size_t k : thickest_first()) {
      const double hull = hull_bound(k);
      if (hull <= enough() || left_ == 0) {  // and so are those after it
        upper = std::fmax(upper, hull);
        break;
      }
      upper = std::fmax(upper, std::fmin(hull, upper_end(k)));
    }
    best_.upper = std::fmax(std::fmin(known, upper), best_.lower);
    return best_;
  }

 private:
  // Of 2 min(d_A - e_A, d_B - e_B) in a component; rounded up.
  double hull_bound(std::size_t k) const {
    return std::nextafter(balls_[k].upper - 2 * std::fmin(goal_.less_a, goal_.less_b), INFINITY);
  }

  void take_ball(const ThicknessInterval& ball) {
    ThicknessInterval less = ball;
    less.lower = std::nextafter(2 * (ball.radius - std::fmax(goal_.less_a, goal_.less_b)), -INFINITY);
    if (ball.found) take_point(less);
  }

  void take_point(const ThicknessInterval& other) {
    if (!(other.lower > best_.lower)) return;
    best_.lower = other.lower;
    best_.found = other.found;
    best_.centre = other.centre;
    best_.radius = other.radius;
  }

  // A component with a bound no larger is not searched.
  double enough() const {
    const double narrow = best_.lower > 0 ? best_.lower / (1 - goal_.width) : best_.lower;
    return goal_.limit ? std::fmax(narrow, *goal_.limit) : narrow;
  }

  std::vector<std::size_t> thickest_first() const {
    std::vector<std::size_t> order(balls_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto p, auto q) { return balls_[p].upper > balls_[q].upper; });
    return order;
  }

  // Proven, of a component that is searched.
  double upper_end(std::size_t k) {
    ThicknessGoal goal = goal_;
    goal.within = box_around(overlap_.components[k]);
    goal.limit = enough();
    ThicknessInterval interval = searched(goal);
    if (!goal_.limit && interval.lower > *goal.limit && left_ > 0) {
      goal.limit.reset();
      interval = searched(goal);
    }
    return interval.upper;
  }

  ThicknessInterval searched(ThicknessGoal& goal) {
    goal.work = left_;
    const ThicknessInterval interval = search_(goal);
    left_ -= std::min(left_, interval.work);
    best_.work += interval.work;
    best_.boxes += interval.boxes;
    if (interval.found) take_point(interval);
    return interval;
  }

  const OverlapComponents& overlap_;
  std::vector<ThicknessInterval> balls_;
  const ThicknessGoal& goal_;
  ThicknessInterval best_;
  const SearchWithin& search_;
  std::uint64_t left_;
};

}  // namespace

std::optional<ThicknessInterval> search_components(const Surface& a, const Surface& b, const ThicknessGoal& goal,
                                                   const ThicknessInterval& known, const SearchWithin& search) {
  const OverlapComponents overlap = overlap_components(a, b, kMostPairs);
  if (!overlap.resolved) return std::nullopt;
  return ComponentSearch(overlap, component_balls(a, b, overlap), goal, known, search).run();
}

}  // namespace satcheck
