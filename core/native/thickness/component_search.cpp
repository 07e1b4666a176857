#include "thickness/component_search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "thickness/component_balls.hpp"
#include "thickness/component_box.hpp"

namespace satcheck {
namespace {

// Of triangles that meet; more take longer than they are worth.
constexpr std::size_t kMostPairs = 100'000;

// A hull that is thicker than all of the overlap by this factor says nothing about its component.
constexpr double kThicker = 2;

class ComponentSearch {
 public:
  ComponentSearch(const OverlapComponents& overlap, std::vector<ThicknessInterval> balls, const ThicknessGoal& goal,
                  const ThicknessInterval& known, const SearchWithin& search)
      : overlap_(overlap), balls_(std::move(balls)), goal_(goal), best_(known), search_(search), left_(goal.work) {}

  ThicknessInterval run() {
    const double known = best_.upper;
    for (const ThicknessInterval& ball : balls_) {
      take_ball(ball);
      upper_.push_back(hull_bound(ball));
    }
    narrow([&](std::size_t open) { return left_ / open; });
    narrow([&](std::size_t) { return left_; });
    double upper = best_.lower;
    for (const double of_one : upper_) upper = std::fmax(upper, of_one);
    best_.upper = std::fmax(std::fmin(known, upper), best_.lower);
    return best_;
  }

 private:
  // Of 2 min(d_A - e_A, d_B - e_B) in a component; rounded up.
  double hull_bound(const ThicknessInterval& ball) const {
    return std::nextafter(ball.upper - 2 * std::fmin(goal_.less_a, goal_.less_b), INFINITY);
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

  // All components that leave the goal open, the thickest first. share: of the work, by how many they are.
  template <class Share>
  void narrow(Share share) {
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < upper_.size(); ++k) {
      if (upper_[k] > enough()) open.push_back(k);
    }
    std::stable_sort(open.begin(), open.end(), [&](auto p, auto q) { return upper_[p] > upper_[q]; });
    for (std::size_t i = 0; i < open.size() && left_ > 0; ++i) {
      double& upper = upper_[open[i]];
      if (upper <= enough()) break;  // and so are those after it
      share_ = share(open.size() - i);
      upper = std::fmin(upper, upper_end(open[i]));
    }
  }

  // Proven, of a component that is searched.
  double upper_end(std::size_t k) {
    ThicknessGoal goal = goal_;
    goal.within = box_around(overlap_.components[k]);
    goal.limit = enough();
    ThicknessInterval interval = searched(goal);
    if (!goal_.limit && interval.lower > *goal.limit && share_ > 0) {
      goal.limit.reset();
      interval = searched(goal);
    }
    return interval.upper;
  }

  ThicknessInterval searched(ThicknessGoal& goal) {
    goal.work = share_;
    const ThicknessInterval interval = search_(goal);
    left_ -= std::min(left_, interval.work);
    share_ -= std::min(share_, interval.work);
    best_.work += interval.work;
    best_.boxes += interval.boxes;
    if (interval.found) take_point(interval);
    return interval;
  }

  const OverlapComponents& overlap_;
  std::vector<ThicknessInterval> balls_;
  const ThicknessGoal& goal_;
  ThicknessInterval best_;
  std::vector<double> upper_;  // of each component
  const SearchWithin& search_;
  std::uint64_t left_;       // of the work
  std::uint64_t share_ = 0;  // of that, for one component
};

}  // namespace

std::optional<ThicknessInterval> search_components(const Surface& a, const Surface& b, const ThicknessGoal& goal,
                                                   const ThicknessInterval& known, const SearchWithin& search) {
  const OverlapComponents overlap = overlap_components(a, b, kMostPairs);
  if (!overlap.resolved) return std::nullopt;
  std::vector<ThicknessInterval> balls = component_balls(a, b, overlap);
  const auto is_thick = [&](const ThicknessInterval& ball) {
    return ball.upper - 2 * std::fmin(goal.less_a, goal.less_b) > kThicker * known.upper;
  };
  const auto thick = static_cast<std::uint64_t>(std::count_if(balls.begin(), balls.end(), is_thick));
  if (thick * known.work > goal.work) return std::nullopt;
  return ComponentSearch(overlap, std::move(balls), goal, known, search).run();
}

}  // namespace satcheck
