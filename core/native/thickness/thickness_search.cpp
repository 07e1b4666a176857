// Method: branch and bound over convex cells of space, largest bound first (cell_bound.hpp).
#include "thickness/thickness_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/work.hpp"
#include "depth/exact_centre.hpp"
#include "mesh/surface_order.hpp"
#include "mesh_pair/moved_surface.hpp"
#include "thickness/cell_bound.hpp"
#include "thickness/component_search.hpp"

namespace satcheck {
namespace {

// Measured steps of a cell, and steps between two calls of poll().
constexpr std::uint64_t kCellWork = 1000, kPollWork = 50'000'000;

// Of work, until the components of the overlap are looked at: at least, and for each triangle.
constexpr std::uint64_t kPatience = 10'000'000, kPatiencePerTriangle = 2000;

// Bounds below this many roundings are not divided further: rounding keeps them above 0.
constexpr double kNoise = 1024;

// A corner of a cell may be off by this share of the scale, and by this share of what its bound is too large by.
constexpr double kLeastError = 2e-13, kShareOfError = 1e-5;

// Patches may deviate from a plane by this share of the largest radius that the boxes of the bodies allow.
constexpr double kFlatness = 1e-7;

bool smaller_bound(const std::unique_ptr<OpenCell>& a, const std::unique_ptr<OpenCell>& b) {
  return a->bound != b->bound ? a->bound < b->bound : a->number > b->number;
}

class Search {
 public:
  // centre: was subtracted from both surfaces.
  Search(const Surface& a, const Surface& b, const ThicknessGoal& goal, Vec3 centre)
      : bodies_(a, b, goal), goal_(goal), centre_(centre) {
    best_ = dropped_ = floor_ = 0.0 - std::fmax(goal.less_a, goal.less_b);
  }

  ThicknessInterval run() {
    if (goal_.prove && goal_.across < 0) record_.emplace();
    search();
    if (record_ && box_) result_.proof = std::make_shared<ThicknessProof>(record_->proof(bodies_, centre_, *box_));
    return result_;
  }

 private:
  void search() {
    push_root();
    while (!open_.empty()) {
      if (finish(open_.front()->bound)) return;
      std::pop_heap(open_.begin(), open_.end(), smaller_bound);
      const std::unique_ptr<OpenCell> cell = std::move(open_.back());
      open_.pop_back();
      divide(*cell);
    }
    finish(floor_);
  }

  std::uint64_t work() const { return work_done - start_; }

  // A cell whose bound is no larger does not have to be divided.
  double enough() const {
    const bool flush = bodies_.less(0) == 0 && bodies_.less(1) == 0;  // then 0 is where surfaces meet
    const double narrow = std::fmax(best_ > 0 ? best_ / (1 - goal_.width) : best_, flush ? kNoise * bodies_.rounding() : 0.0);
    return goal_.limit ? std::fmax(narrow, *goal_.limit / 2) : narrow;
  }

  // Whether the interval is good enough, or the work is spent, where no open cell has a larger bound.
  bool finish(double open) {
    const double upper = std::fmax(std::fmax(open, dropped_), best_);
    result_.lower = 2 * best_;
    result_.upper = 2 * upper;
    result_.work = work();
    const bool decided = goal_.limit && (result_.lower > *goal_.limit || result_.upper <= *goal_.limit);
    const bool narrow = upper - best_ <= goal_.width * std::fabs(upper) || open_.empty();
    result_.stop = decided ? ThicknessStop::decided : narrow ? ThicknessStop::narrow : ThicknessStop::work_spent;
    if (decided || narrow || work() >= goal_.work) return true;
    if (goal_.poll && work() >= next_poll_) {
      next_poll_ = work() + kPollWork;
      goal_.poll();
    }
    return false;
  }

  // No ball in both is larger than the box that is common to their boxes.
  void push_root() {
    const Aabb box = common_box(bodies_.surface(0).bvh.nodes[0].box, bodies_.surface(1).bvh.nodes[0].box);
    Vec3 low = box.min, high = box.max;
    if (goal_.within) {
      const Vec3 wider = Vec3{1, 1, 1} * bodies_.rounding();
      axes_ = goal_.within->axes;
      low = goal_.within->low - axes_ * centre_ - wider;
      high = goal_.within->high - axes_ * centre_ + wider;
    }
    double half = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(high[axis] > low[axis])) return;
      if (axis != goal_.across) half = std::fmin(half, (high[axis] - low[axis]) / 2);
    }
    OpenCell root;
    root.bound = half + std::fabs(bodies_.less(0) - bodies_.less(1)) + bodies_.rounding();
    if (goal_.across >= 0) {
      const Vec3 middle = low * 0.5 + high * 0.5;
      double& from = goal_.across == 0 ? low.x : goal_.across == 1 ? low.y : low.z;
      double& to = goal_.across == 0 ? high.x : goal_.across == 1 ? high.y : high.z;
      from = to = middle[goal_.across];
    }
    root.cell = make_cell(axes_, low, high, goal_.across, bodies_.scale());
    const double reach = root.bound + std::fmax(bodies_.less(0), bodies_.less(1)) + 2 * bodies_.rounding();
    bodies_.make_patches(root.cell.box(), reach, kFlatness * half);
    box_ = box;
    if (record_) root.node = record_->add_root();
    add(std::make_unique<OpenCell>(std::move(root)));
  }

  // Bounds the cell, and keeps it if its bound is too large.
  void add(std::unique_ptr<OpenCell> cell) {
    ++result_.boxes;
    work_done += kCellWork;
    bound_cell(bodies_, axes_, *cell, best_, enough(), [&](Vec3 p) { return consider(p); },
               record_ ? &*record_ : nullptr);
    if (cell->bound <= enough()) {
      dropped_ = std::fmax(dropped_, cell->bound);
      return;
    }
    cell->number = next_number_++;
    open_.push_back(std::move(cell));
    std::push_heap(open_.begin(), open_.end(), smaller_bound);
  }

  // Takes p, rounded to a point of the world frame, for a lower bound, if it is inside both. The body it is outside of.
  int consider(Vec3 p) {
    const Vec3 world = p + centre_;
    p = world - centre_;
    for (int body = 0; body < 2; ++body) {
      if (!bodies_.is_inside(body, p)) return body;
    }
    const double in_a = bodies_.clearance(0, p), in_b = bodies_.clearance(1, p);
    const double depth = std::fmin(in_a - bodies_.less(0), in_b - bodies_.less(1)) - bodies_.rounding();
    if (depth > best_) {
      best_ = depth;
      result_.found = true;
      result_.centre = world;
      result_.radius = std::fmin(in_a, in_b);
    }
    return -1;
  }

  void divide(OpenCell& parent) {
    auto halves = divided(parent, kShareOfError * (parent.bound - enough()));
    if (!halves) halves = divided(parent, kShareOfError * (parent.bound - best_));
    if (!halves) {  // nothing is left to divide
      dropped_ = std::fmax(dropped_, parent.bound);
      return;
    }
    std::pair<std::uint32_t, std::uint32_t> nodes;
    if (record_) nodes = record_->divide(parent.node, halves->plane);
    for (Cell* part : {&halves->below, &halves->above}) {
      const std::uint32_t node = part == &halves->below ? nodes.first : nodes.second;
      auto child = std::make_unique<OpenCell>(OpenCell{parent.bound, std::move(*part), parent.near, parent.is_listed,
                                                       parent.columns, parent.inside, {}, 0, node});
      add(std::move(child));
    }
  }

  // error: of new corners.
  std::optional<Halves> divided(const OpenCell& parent, double error) const {
    error = std::fmax(error, kLeastError * bodies_.scale());
    std::optional<Halves> halves;
    if (parent.cut) halves = split(parent.cell, *parent.cut, bodies_.scale(), error);
    for (int axis = 0; axis < 3 && !halves; ++axis) {
      halves = split(parent.cell, longest_cut(parent.cell, axis), bodies_.scale(), error);
    }
    return halves;
  }

  // Through the middle, across the longest axis of the cell, or the second or third longest.
  HalfSpace longest_cut(const Cell& cell, int rank) const {
    std::array<std::pair<double, HalfSpace>, 3> cuts;
    for (int axis = 0; axis < 3; ++axis) {
      double low = INFINITY, high = -INFINITY;
      for (const Cell::Corner& corner : cell.corners) {
        low = smaller(low, dot(axes_.row[axis], corner.at));
        high = larger(high, dot(axes_.row[axis], corner.at));
      }
      cuts[static_cast<std::size_t>(axis)] = {high - low, {axes_.row[axis], (low + high) / 2}};
    }
    std::stable_sort(cuts.begin(), cuts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    return cuts[static_cast<std::size_t>(rank)].second;
  }

  TwoBodies bodies_;
  ThicknessGoal goal_;
  Vec3 centre_;
  Mat3 axes_;
  std::optional<Aabb> box_;  // common to the boxes of the bodies
  std::optional<ThicknessRecord> record_;
  std::uint64_t start_ = work_done;
  double floor_, best_, dropped_;
  ThicknessInterval result_;
  std::vector<std::unique_ptr<OpenCell>> open_;  // a heap, largest bound first
  std::uint64_t next_number_ = 0, next_poll_ = kPollWork;
};

ThicknessInterval search_in_order(const Surface& a, const Surface& b, const ThicknessGoal& goal) {
  const Vec3 centre = exact_centre(a, b);
  if (centre == Vec3{}) return Search(a, b, goal, centre).run();
  MovedSurface moved_a(a), moved_b(b);
  return Search(moved_a.at(-centre), moved_b.at(-centre), goal, centre).run();
}

ThicknessInterval search_either_way(const Surface& a, const Surface& b, const ThicknessGoal& goal) {
  if (comes_before(a, b)) return search_in_order(a, b, goal);
  ThicknessGoal swapped = goal;
  std::swap(swapped.less_a, swapped.less_b);
  ThicknessInterval interval = search_in_order(b, a, swapped);
  if (interval.proof) interval.proof->swap_bodies();
  return interval;
}

ThicknessStop stop_of(const ThicknessInterval& interval, const ThicknessGoal& goal) {
  if (goal.limit && (interval.lower > *goal.limit || interval.upper <= *goal.limit)) return ThicknessStop::decided;
  const bool narrow = interval.upper - interval.lower <= goal.width * std::fabs(interval.upper);
  return narrow ? ThicknessStop::narrow : ThicknessStop::work_spent;
}

}  // namespace

// Many small components, as between the facets of a bolt and those of its hole, take one search of all of them long.
ThicknessInterval search_thickness(const Surface& a, const Surface& b, const ThicknessGoal& goal) {
  if (!a.solid || !b.solid) throw std::invalid_argument("the thickness of an overlap needs two solids");
  const bool has_components = goal.across < 0 && !goal.prove && !goal.within;
  const std::uint64_t patience = kPatience + kPatiencePerTriangle * (a.mesh.triangles.size() + b.mesh.triangles.size());
  if (!has_components || goal.work <= patience) return search_either_way(a, b, goal);
  ThicknessGoal next = goal;
  next.work = patience;
  const ThicknessInterval first = search_either_way(a, b, next);
  if (first.stop != ThicknessStop::work_spent) return first;
  next.work = goal.work - patience;
  const auto search = [&](const ThicknessGoal& of_one) { return search_either_way(a, b, of_one); };
  std::optional<ThicknessInterval> interval = search_components(a, b, next, first, search);
  if (!interval) return search_either_way(a, b, goal);
  interval->stop = stop_of(*interval, goal);
  return *interval;
}

}  // namespace satcheck
