// Method: branch and bound over convex cells of space, largest bound first (cell_bound.hpp).
#include "thickness/thickness_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "mesh_pair/moved_surface.hpp"
#include "thickness/cell_bound.hpp"
#include "thickness/component_search.hpp"

namespace satcheck {
namespace {

// Measured steps of a cell.
constexpr std::uint64_t kCellWork = 1000;

// Of work, until the components of the overlap are looked at: at least, and for each triangle. If their hulls do not
// decide, the whole overlap is searched for half of that time again: the search is often almost at its end.
constexpr std::uint64_t kPatience = 10'000'000, kPatiencePerTriangle = 2000;

// Bounds below this many roundings are not divided further: rounding keeps them above 0.
constexpr double kNoise = 1024;

// A corner of a cell may be off by this share of the scale, and by this share of what its bound is too large by.
constexpr double kLeastError = 2e-13, kShareOfError = 1e-5;

// Patches may deviate from a plane by this share of the largest radius that the boxes of the bodies allow.
constexpr double kFlatness = 1e-7;

// So many cells, those with the largest bounds, are divided at a time at most, on all cores. The number does not depend
// on the cores, so neither does the answer. With more, a deeper point that one of them has comes too late for more of the
// others; with fewer, starting threads takes as long as the cells.
constexpr std::size_t kBatch = 64;
// Fewer cells are not worth a thread.
constexpr std::size_t kWorthThreads = 8;

class Search {
 public:
  // centre: was subtracted from both surfaces.
  Search(const Surface& a, const Surface& b, const ThicknessGoal& goal, Vec3 centre)
      : bodies_(a, b, goal), goal_(goal), budget_(goal.work, goal.poll), centre_(centre) {
    best_ = dropped_ = floor_ = 0.0 - std::fmax(goal.less_a, goal.less_b);
    if (goal.prove && goal.across < 0) record_.emplace();
  }

  // Goes on until this many steps have been spent in all.
  ThicknessInterval run(std::uint64_t most_work) {
    budget_.end_at(most_work);
    search();
    if (record_ && box_) result_.proof = std::make_shared<ThicknessProof>(record_->proof(bodies_, centre_, *box_));
    return result_;
  }

 private:
  void search() {
    if (!box_) push_root();
    while (!open_.empty()) {
      if (finish(open_.key())) return;
      divide_largest();
    }
    finish(floor_);
  }

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
    result_.work = budget_.spent();
    const bool decided = goal_.limit && (result_.lower > *goal_.limit || result_.upper <= *goal_.limit);
    const bool narrow = upper - best_ <= goal_.width * std::fabs(upper) || open_.empty();
    result_.stop = decided ? SearchStop::decided : narrow ? SearchStop::narrow : SearchStop::work_spent;
    if (decided || narrow || budget_.is_spent()) return true;
    if (budget_.is_due()) budget_.tell(result_.lower, result_.upper);
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
    double half = goal_.most / 2;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(high[axis] > low[axis])) return;
      if (axis != goal_.across) half = std::fmin(half, (high[axis] - low[axis]) / 2);
    }
    OpenCell root;
    root.bound = half + std::fabs(bodies_.less(0) - bodies_.less(1)) + bodies_.rounding();
    if (goal_.across >= 0) {
      low.at(goal_.across) = high.at(goal_.across) = Aabb{low, high}.centre()[goal_.across];
    }
    root.cell = make_cell(axes_, low, high, goal_.across, bodies_.scale());
    const double reach = root.bound + std::fmax(bodies_.less(0), bodies_.less(1)) + 2 * bodies_.rounding();
    bodies_.make_patches(root.cell.box(), reach, kFlatness * half);
    box_ = box;
    if (record_) root.node = record_->add_root();
    Share share{{}, {}, best_};
    share.cells.push_back(std::make_unique<OpenCell>(std::move(root)));
    bound(share, enough());
    add(share);
  }

  // A cell that is divided, its parts, and what is found in them: the deepest point inside both bodies, if it is deeper
  // than the best one before. Threads write into shares of their own.
  struct Share {
    std::unique_ptr<OpenCell> parent;
    std::vector<std::unique_ptr<OpenCell>> cells;
    double depth;
    bool found = false;
    Vec3 centre{};  // world frame
    double radius = 0;
    Budget budget{};  // counted in add(), on the thread of the search
  };

  // How many cells to divide: no more than the work that is left allows, if their halves take twice what cells took so far.
  std::size_t batch() const {
    const std::uint64_t of_cell = budget_.spent() / std::max<std::uint64_t>(result_.boxes, 1) + kCellWork;
    return std::clamp<std::size_t>(budget_.left() / (4 * of_cell), 1, kBatch);
  }

  void divide_largest() {
    std::vector<Share> shares;
    const std::size_t most = batch();
    while (shares.size() < most && !open_.empty() && (shares.empty() || open_.key() > enough())) {
      shares.push_back({open_.pop(), {}, best_});
    }
    const double enough = this->enough();
    // A record is written in order.
    const unsigned threads = record_ || shares.size() < kWorthThreads ? 1 : goal_.threads;
    parallel_for(shares.size(), threads, [&](std::size_t i) {
      divide(shares[i], enough);
      bound(shares[i], enough);
    });
    for (Share& share : shares) add(share);
  }

  void bound(Share& share, double enough) {
    const double best = share.depth;
    for (const std::unique_ptr<OpenCell>& cell : share.cells) {
      share.budget.spend(kCellWork);
      bound_cell(bodies_, axes_, *cell, best, enough, [&](Vec3 p) { return consider(p, share); }, record_ ? &*record_ : nullptr,
                 share.budget);
    }
  }

  void add(Share& share) {
    budget_.spend(share.budget.spent());
    result_.boxes += static_cast<std::uint32_t>(share.cells.size());
    if (share.cells.empty()) dropped_ = std::fmax(dropped_, share.parent->bound);  // nothing is left to divide
    if (share.found && share.depth > best_) {
      best_ = share.depth;
      result_.found = true;
      result_.centre = share.centre;
      result_.radius = share.radius;
    }
    for (std::unique_ptr<OpenCell>& cell : share.cells) keep(std::move(cell));
  }

  // Opens the cell if its bound is too large.
  void keep(std::unique_ptr<OpenCell> cell) {
    if (cell->bound <= enough()) {
      dropped_ = std::fmax(dropped_, cell->bound);
      return;
    }
    const double bound = cell->bound;
    open_.push(bound, std::move(cell));
  }

  // Takes p, rounded to a point of the world frame, for a lower bound, if it is inside both. The body it is outside of.
  int consider(Vec3 p, Share& share) const {
    const Vec3 world = p + centre_;
    p = world - centre_;
    for (int body = 0; body < 2; ++body) {
      if (!bodies_.is_inside(body, p, share.budget)) return body;
    }
    const double in_a = bodies_.clearance(0, p, share.budget), in_b = bodies_.clearance(1, p, share.budget);
    const double depth = std::fmin(in_a - bodies_.less(0), in_b - bodies_.less(1)) - bodies_.rounding();
    if (depth > share.depth) {
      share.depth = depth;
      share.found = true;
      share.centre = world;
      share.radius = std::fmin(in_a, in_b);
    }
    return -1;
  }

  void divide(Share& share, double enough) {
    const OpenCell& parent = *share.parent;
    auto halves = divided(parent, kShareOfError * (parent.bound - enough));
    if (!halves) halves = divided(parent, kShareOfError * (parent.bound - share.depth));
    if (!halves) return;
    std::pair<std::uint32_t, std::uint32_t> nodes;
    if (record_) nodes = record_->divide(parent.node, halves->plane);
    for (Cell* part : {&halves->below, &halves->above}) {
      const std::uint32_t node = part == &halves->below ? nodes.first : nodes.second;
      share.cells.push_back(std::make_unique<OpenCell>(OpenCell{parent.bound, std::move(*part), parent.near, parent.met,
                                                                parent.columns, parent.inside, {}, node}));
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
      const Range along = cell.along(axes_.row[axis]);
      cuts[static_cast<std::size_t>(axis)] = {along.width(), {axes_.row[axis], along.middle()}};
    }
    std::stable_sort(cuts.begin(), cuts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    return cuts[static_cast<std::size_t>(rank)].second;
  }

  TwoBodies bodies_;
  ThicknessGoal goal_;
  Budget budget_;
  Vec3 centre_;
  Mat3 axes_;
  std::optional<Aabb> box_;  // common to the boxes of the bodies
  std::optional<ThicknessRecord> record_;
  double floor_, best_, dropped_;
  ThicknessInterval result_;
  BestFirst<std::unique_ptr<OpenCell>> open_;  // the largest bound first
};

// The search of two surfaces near the origin, in the order that does not depend on which of them is called A.
class OrderedSearch {
 public:
  OrderedSearch(const Surface& a, const Surface& b, ThicknessGoal goal)
      : swapped_(!comes_before(a, b)), pair_(swapped_ ? b : a, swapped_ ? a : b) {
    if (swapped_) std::swap(goal.less_a, goal.less_b);
    search_.emplace(pair_.a, pair_.b, goal, pair_.centre);
  }

  ThicknessInterval run(std::uint64_t most_work) {
    ThicknessInterval interval = search_->run(most_work);
    if (interval.proof && swapped_) interval.proof->swap_bodies();
    return interval;
  }

 private:
  bool swapped_;
  NearOrigin pair_;
  std::optional<Search> search_;
};

SearchStop stop_of(const ThicknessInterval& interval, const ThicknessGoal& goal) {
  if (goal.limit && (interval.lower > *goal.limit || interval.upper <= *goal.limit)) return SearchStop::decided;
  const bool narrow = interval.upper - interval.lower <= goal.width * std::fabs(interval.upper);
  return narrow ? SearchStop::narrow : SearchStop::work_spent;
}

}  // namespace

// Many small components, as between the facets of a bolt and those of its hole, take one search of all of them long.
ThicknessInterval search_thickness(const Surface& a, const Surface& b, const ThicknessGoal& goal) {
  if (!a.solid || !b.solid) throw std::invalid_argument("the thickness of an overlap needs two solids");
  OrderedSearch whole(a, b, goal);
  const bool has_components = goal.across < 0 && !goal.prove && !goal.within;
  const std::uint64_t patience = kPatience + kPatiencePerTriangle * (a.mesh.triangles.size() + b.mesh.triangles.size());
  if (!has_components || goal.work <= patience) return whole.run(goal.work);
  ThicknessInterval known = whole.run(patience);
  if (known.stop != SearchStop::work_spent) return known;
  ComponentSearch components(a, b, goal, known);
  if (!components.resolved()) return whole.run(goal.work);
  ThicknessInterval interval = components.bound(known);
  if (stop_of(interval, goal) == SearchStop::work_spent) {
    const bool is_thick = components.are_thick(known);
    known = whole.run(is_thick ? goal.work : std::min(goal.work, patience + patience / 2));
    if (known.stop != SearchStop::work_spent) return known;
    const auto within = [&](const ThicknessGoal& of_one) { return OrderedSearch(a, b, of_one).run(of_one.work); };
    interval = is_thick ? components.bound(known) : components.search(known, within);
  }
  interval.stop = stop_of(interval, goal);
  return interval;
}

}  // namespace satcheck
