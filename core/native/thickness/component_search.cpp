#include "thickness/component_search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh_pair/mesh_pair.hpp"
#include "thickness/component_balls.hpp"

namespace satcheck {
namespace {

// Of triangles that meet; more take longer than they are worth.
constexpr std::size_t kMostPairs = 100'000;

// A hull that is thicker than all of the overlap by this factor says nothing about its component.
constexpr double kThicker = 2;

// Of 2 min(d_A - e_A, d_B - e_B) in a component; rounded up.
double hull_bound(const ThicknessInterval& ball, const ThicknessGoal& goal) {
  return std::nextafter(ball.upper - 2 * std::fmin(goal.less_a, goal.less_b), INFINITY);
}

}  // namespace

ComponentSearch::ComponentSearch(const Surface& a, const Surface& b, const ThicknessGoal& goal, const ThicknessInterval& known)
    : goal_(goal), budget_(goal.work, goal.poll) {
  budget_.note(known.lower, known.upper);
  Budget of_pair = budget_of_pair(a.mesh, b.mesh, [this](const SearchState& state) { budget_.tell_again(state.work); });
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
