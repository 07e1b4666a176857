// Method: for convex functions h_i >= depth in the cell and weights lambda_i >= 0 of sum 1, sum lambda_i h_i bounds the
// depth and is convex, so its maximum over the cell is at a corner. The weights that make this maximum least are those of
// a matrix game, corners against functions. The other player's weights give a point of the cell, and what is nearest to
// it is the next function: James E. Kelley, "The Cutting-Plane Method for Solving Convex Programs" (1960).
#include "thickness/cell_bound.hpp"

#include <algorithm>
#include <cmath>

#include "base/work.hpp"
#include "exact/triangle_distance.hpp"
#include "thickness/matrix_game.hpp"

namespace satcheck {
namespace {

// Measured steps: of a distance, of a patch that is held against a cell, of a corner of the game, of its solution.
constexpr std::uint64_t kDistanceWork = 25, kFilterWork = 4, kGameWork = 100;

// Functions that are added before a cell is split; while all are planes, and the bound is exact, many more.
constexpr std::size_t kMostColumns = 14, kMostPlanes = 200;
// A weighted sum of up to kMostPlanes values, each off by bodies.rounding() and below 4 times the scale, and the weights'
// own sum: 2 * 200 roundoffs of that beside the values' own, in units of bodies.rounding(), rounded up.
constexpr double kSumRounding = 8;
// A body may reach beyond a plane by this share of the bound.
constexpr double kPlaneTolerance = 1e-3;
// A cell is not refined further once this share of the way from its bound to what is enough is a gap that only splits close.
constexpr double kHopeless = 0.5;
// A void next to few patches is split off, leaving a layer of this share of what is enough.
constexpr std::size_t kFewPatches = 12;
constexpr double kLayer = 0.25;
// Cells with more corners are split along the axes only.
constexpr std::size_t kManyCorners = 28;

struct Nearest {
  double depth = INFINITY;
  std::uint32_t patch = 0;
};

class CellBound {
 public:
  CellBound(const TwoBodies& bodies, const Mat3& axes, OpenCell& open, double best, double enough, const Consider& consider,
            ThicknessRecord* record)
      : bodies_(bodies), axes_(axes), open_(open), cell_(open.cell), best_(best), enough_(enough), consider_(consider), record_(record), box_(cell_.box()) {}

  void run() {
    floor_ = -std::fmax(bodies_.less(0), bodies_.less(1));
    for (int body = 0; body < 2; ++body) {
      if (is_outside(body)) {
        open_.bound = floor_;
        if (record_ != nullptr) record_->set_outside(open_.node, body);
        return;
      }
    }
    const double bound = solve() + kSumRounding * bodies_.rounding() + cell_.error;
    if (bound < open_.bound) {
      if (record_ != nullptr) record_->set_bound(open_.node, std::move(terms_));
      open_.bound = bound;
    }
    if (open_.bound <= enough_) return;
    choose_cut();
    keep_columns();
  }

 private:
  // All that is no farther from the cell than its points can be deep in the body.
  Aabb reach_of(int body) const {
    const double reach = open_.bound + bodies_.less(body) + 2 * bodies_.rounding();
    const Vec3 wide{reach, reach, reach};
    return {box_.min - wide, box_.max + wide};
  }

  // Leaves out patches too far away to matter. Whether the body has no point inside the cell.
  bool is_outside(int body) {
    const auto side = static_cast<std::size_t>(body);
    PatchList& near = open_.near[side];
    const Aabb around = reach_of(body);
    work_done += kFilterWork * near.size();
    std::erase_if(near, [&](std::uint32_t i) { return !meet(bodies_.patch(body, i).box, around); });
    if (open_.inside[side]) return false;
    for (const std::uint32_t i : near) met_[side] += may_meet(body, i);
    if (met_[side] > 0) return false;
    Vec3 middle;
    for (const Cell::Corner& corner : cell_.corners) middle = middle + corner.at;
    middle = middle * (1.0 / static_cast<double>(cell_.corners.size()));
    if (bodies_.is_outside(body, middle)) return true;
    open_.inside[side] = bodies_.is_inside(body, middle);
    return false;
  }

  // Whether the patch may have a point in the interior of the cell.
  bool may_meet(int body, std::uint32_t number) const {
    const Patch& patch = bodies_.patch(body, number);
    if (!meet(patch.box, box_)) return false;
    work_done += kDistanceWork;
    const double close = cell_.error + bodies_.rounding() / 4;
    const Vec3* outline = bodies_.patches(body).outlines.data() + patch.first;
    for (const HalfSpace& side : cell_.sides) {
      double least = INFINITY;
      for (std::uint32_t i = 0; i < patch.count; ++i) least = smaller(least, dot(side.normal, outline[i]));
      if (least >= side.height + close) return false;
    }
    double low = INFINITY, high = -INFINITY;
    for (const Cell::Corner& corner : cell_.corners) {
      const double s = dot(patch.normal, corner.at - patch.origin);
      low = smaller(low, s);
      high = larger(high, s);
    }
    const double slack = patch.slack + close;
    return !(low > slack || high < -slack);
  }

  double solve() {
    // A cut leaves the cell by no more than that.
    floor_of_game_ = floor_ - norm(box_.max - box_.min) - bodies_.rounding();
    game_.emplace(cell_.corners.size(), floor_of_game_);
    for (const Column& column : open_.columns) add(column.plane ? column : best_column(column.body, column.patch));
    if (columns_.empty() && !add_nearest(box_.min * 0.5 + box_.max * 0.5)) return INFINITY;
    double bound = INFINITY;
    while (true) {
      game_->solve();
      work_done += kGameWork * cell_.corners.size();
      const double shown = proven();
      if (record_ != nullptr && shown < bound) keep_terms();
      bound = std::fmin(bound, shown);
      if (bound <= enough_) return bound;
      point_ = {};
      for (std::size_t k = 0; k < cell_.corners.size(); ++k) point_ = point_ + cell_.corners[k].at * game_->row_weights()[k];
      const double before = depth_;
      if (!add_nearest(point_)) return bound;
      if (columns_.size() >= (only_planes_ ? kMostPlanes : kMostColumns)) return bound;
      if (!only_planes_ && before < INFINITY && bound - depth_ < kHopeless * (bound - enough_)) return bound;
    }
  }

  // The largest weighted sum at a corner.
  double proven() const {
    const std::vector<double>& weights = game_->column_weights();
    double total = 0, bound = -INFINITY;
    for (const double weight : weights) total += weight;
    const std::size_t rows = cell_.corners.size();
    for (std::size_t k = 0; k < rows; ++k) {
      double sum = 0;
      for (std::size_t c = 0; c < weights.size(); ++c) sum += weights[c] * values_[rows * c + k];
      bound = std::fmax(bound, sum / total);
    }
    return bound;
  }

  bool add(const Column& column) {
    for (const Column& known : columns_) {
      if (known.body == column.body && known.patch == column.patch && known.plane == column.plane) return false;
    }
    columns_.push_back(column);
    only_planes_ = only_planes_ && column.plane;
    for (const Cell::Corner& corner : cell_.corners) values_.push_back(std::fmax(bodies_.value(column, corner.at), floor_of_game_));
    work_done += kDistanceWork * cell_.corners.size();
    game_->add({values_.data() + values_.size() - cell_.corners.size(), cell_.corners.size()});
    return true;
  }

  // The plane of the patch, where that will do, or its distance.
  Column best_column(int body, std::uint32_t patch) const {
    const PatchList& near = open_.near[static_cast<std::size_t>(body)];
    const auto plane = bodies_.plane_column(body, patch, reach_of(body), near, kPlaneTolerance * open_.bound);
    return plane ? *plane : Column{patch, false, body, 0, 1};
  }

  // The patch nearest to a point of the cell; of several, the one that p is farthest in front of.
  Nearest nearest(int body, Vec3 p) const {
    Nearest best;
    double front = -INFINITY;
    const PatchList& near = open_.near[static_cast<std::size_t>(body)];
    work_done += kFilterWork * near.size();
    const Aabb at{p, p};
    const double tie = bodies_.rounding();
    for (const std::uint32_t i : near) {
      const Patch& patch = bodies_.patch(body, i);
      const double reach = best.depth + tie;
      if (box_distance_squared(at, patch.box) > reach * reach) continue;
      work_done += kDistanceWork;
      const double distance = bodies_.patches(body).distance(patch, p);
      if (distance > best.depth + tie) continue;
      const double in_front = dot(patch.normal, p - patch.origin);
      if (distance < best.depth - tie || in_front > front) {
        front = in_front;
        best.patch = i;
      }
      best.depth = smaller(best.depth, distance);
    }
    best.depth -= bodies_.less(body);
    return best;
  }

  // What is nearest to p becomes a column. Whether it is new.
  bool add_nearest(Vec3 p) {
    nearest_ = {nearest(0, p), nearest(1, p)};
    depth_ = std::fmin(std::fmin(nearest_[0].depth, nearest_[1].depth), open_.bound);
    outside_ = depth_ > best_ ? consider_(p) : -1;
    bool added = false;
    for (int body = 0; body < 2; ++body) {
      const Nearest& here = nearest_[static_cast<std::size_t>(body)];
      if (here.depth < INFINITY && (here.depth <= depth_ || outside_ == body)) added = add(best_column(body, here.patch)) || added;
    }
    return added;
  }

  // Where the cell is split: along the void that the game's point lies in; at the plane of a patch; or across an axis.
  void choose_cut() {
    if (cell_.corners.size() <= kManyCorners) {
      if (outside_ >= 0 && cut_off_void(outside_)) return;
    }
    double most = 0;
    std::optional<HalfSpace> cut;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 along = axes_.row[axis];
      const double gap = gap_along(along);
      if (gap <= most) continue;
      most = gap;
      cut = halving(along);
    }
    if (cell_.corners.size() <= kManyCorners) {
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        const double gap = gap_at_plane(c);
        if (gap <= most) continue;
        const Patch& patch = bodies_.patch(columns_[c].body, columns_[c].patch);
        most = gap;
        cut = HalfSpace{patch.normal, dot(patch.normal, patch.origin)};
      }
    }
    open_.cut = cut;
  }

  HalfSpace halving(Vec3 along) const {
    double low = INFINITY, high = -INFINITY;
    for (const Cell::Corner& corner : cell_.corners) {
      low = smaller(low, dot(along, corner.at));
      high = larger(high, dot(along, corner.at));
    }
    return {along, (low + high) / 2};
  }

  bool cut_off_void(int body) {
    const auto side = static_cast<std::size_t>(body);
    if (met_[side] == 0 || met_[side] > kFewPatches || !(nearest_[side].depth < INFINITY)) return false;
    const ConvexPatches& patches = bodies_.patches(body);
    const Vec3 on_wall = patches.nearest(patches.patches[nearest_[side].patch], point_);
    const double distance = norm(point_ - on_wall);
    const double layer = std::fmax(kLayer * enough_, 4 * bodies_.rounding());
    if (!(distance > 4 * layer)) return false;
    const Vec3 towards = (point_ - on_wall) * (1 / distance);
    open_.cut = HalfSpace{towards, dot(towards, on_wall) + layer};
    return true;
  }

  // By how much the weighted sum is above its value at the game's point because it is not linear along the axis.
  double gap_along(Vec3 along) const {
    double forward = INFINITY, backward = INFINITY;
    for (const HalfSpace& side : cell_.sides) {
      const double slope = dot(side.normal, along), room = std::fmax(side.height - dot(side.normal, point_), 0.0);
      if (slope > kSteep) forward = smaller(forward, room / slope);
      if (slope < -kSteep) backward = smaller(backward, room / -slope);
    }
    if (!(forward < INFINITY && backward < INFINITY && forward + backward > bodies_.rounding())) return 0;
    const double share = backward / (forward + backward);
    double gap = 0;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const double weight = game_->column_weights()[c];
      if (weight <= 0 || columns_[c].plane) continue;
      work_done += 3 * kDistanceWork;
      gap += weight * (share * bodies_.value(columns_[c], point_ + along * forward) + (1 - share) * bodies_.value(columns_[c], point_ - along * backward) -
                       bodies_.value(columns_[c], point_));
    }
    return gap;
  }

  // The same because the patch's plane runs through the cell.
  double gap_at_plane(std::size_t c) const {
    const double weight = game_->column_weights()[c];
    if (weight <= 0 || columns_[c].plane) return 0;
    const Patch& patch = bodies_.patch(columns_[c].body, columns_[c].patch);
    double sum = 0, sum_of_sizes = 0;
    for (std::size_t k = 0; k < cell_.corners.size(); ++k) {
      const double s = game_->row_weights()[k] * dot(patch.normal, cell_.corners[k].at - patch.origin);
      sum += s;
      sum_of_sizes += std::fabs(s);
    }
    return weight * (sum_of_sizes - std::fabs(sum));
  }

  void keep_columns() {
    std::vector<Column> kept;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (game_->column_weights()[c] > 0) kept.push_back(columns_[c]);
    }
    open_.columns = std::move(kept);
  }

  void keep_terms() {
    terms_.clear();
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const double weight = game_->column_weights()[c];
      const double reach = open_.bound + bodies_.less(columns_[c].body) + bodies_.rounding();
      if (weight > 0) terms_.push_back({columns_[c], reach, weight});
    }
  }

  static constexpr double kSteep = 1e-9;

  const TwoBodies& bodies_;
  const Mat3& axes_;
  OpenCell& open_;
  const Cell& cell_;
  double best_, enough_;
  const Consider& consider_;
  ThicknessRecord* record_;
  Aabb box_;
  double floor_ = 0, floor_of_game_ = 0;
  std::array<std::size_t, 2> met_{};  // patches that may meet the cell
  std::optional<MatrixGame> game_;
  std::vector<Column> columns_;
  std::vector<double> values_;  // of each column at all corners
  std::vector<Term> terms_;     // of the least sum, for the record
  bool only_planes_ = true;
  Vec3 point_;  // where the game's other player expects the deepest point
  std::array<Nearest, 2> nearest_;
  double depth_ = INFINITY;  // of that point, if it is inside both
  int outside_ = -1;
};

}  // namespace

void bound_cell(const TwoBodies& bodies, const Mat3& axes, OpenCell& open, double best, double enough, const Consider& consider,
                ThicknessRecord* record) {
  CellBound(bodies, axes, open, best, enough, consider, record).run();
}

}  // namespace satcheck
