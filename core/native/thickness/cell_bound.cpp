// Method: for convex functions h_i >= depth in the cell and weights lambda_i >= 0 of sum 1, sum lambda_i h_i bounds the
// depth and is convex, so its maximum over the cell is at a corner. The weights that make this maximum least are those of
// a matrix game, corners against functions. The other player's weights give a point of the cell, and what is nearest to
// it is the next function: James E. Kelley, "The Cutting-Plane Method for Solving Convex Programs" (1960).
#include "thickness/cell_bound.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "exact/triangle_distance.hpp"
#include "thickness/cell_cut.hpp"
#include "thickness/matrix_game.hpp"
#include "thickness/void_bound.hpp"

namespace satcheck {
namespace {

// Measured steps of a corner of the game, and of its solution.
constexpr std::uint64_t kGameWork = 100;

// Functions that are added before a cell is split; while all are planes, and the bound is exact, many more.
constexpr std::size_t kMostColumns = 14, kMostPlanes = 200;
// A weighted sum of values below 4 times the scale adds a roundoff of that for each value, and three for their weights;
// bodies.rounding() has 256 roundoffs of the scale.
constexpr double kSumRounding = 4.0 / 256;
// A body may reach beyond a plane by this share of the bound.
constexpr double kPlaneTolerance = 1e-3;
// A cell is not refined further once a gap that only splits close makes up this share of the way from its bound to what
// is enough.
constexpr double kHopeless = 0.5;
// A gap below this share of the way from the bound to what is enough is not why the bound is too large. Then the longest
// axis is split, because cuts at such gaps make needles of the cells next to a void.
constexpr double kWorthCut = 0.01;
// A void is split off, leaving a layer of this share of what is enough.
constexpr double kLayer = 0.25;
// With more patches a cell is crowded; with fewer the void between them is looked at, if it may make the bound smaller
// by this factor.
constexpr std::size_t kCrowd = 64;
constexpr double kWorthwhile = 0.12;
// A point in front of a patch is that far from it, as a share of the size of the cell.
constexpr double kInFront = 0.02;
// Where a column is the depth of the game's point, it counts this much although the bound may not rest on it.
constexpr double kNearestWeight = 0.5;

struct Nearest {
  double depth = INFINITY;
  std::uint32_t patch = 0;
};

class CellBound {
 public:
  CellBound(const TwoBodies& bodies, const Mat3& axes, OpenCell& open, double best, double enough, const Consider& consider,
            ThicknessRecord* record, Budget& budget)
      : bodies_(bodies), axes_(axes), open_(open), cell_(open.cell), best_(best), enough_(enough), consider_(consider), record_(record), budget_(budget), box_(cell_.box()) {}

  void run() {
    floor_ = -std::fmax(bodies_.less(0), bodies_.less(1));
    for (const Cell::Corner& corner : cell_.corners) middle_ = middle_ + corner.at;
    const double share = 1.0 / static_cast<double>(cell_.corners.size());
    middle_ = middle_ * share;
    point_ = middle_;
    shares_.assign(cell_.corners.size(), share);
    for (const Cell::Corner& corner : cell_.corners) radius_ = larger(radius_, norm(corner.at - middle_));
    if (record_ == nullptr && is_crowded()) return;
    for (int body = 0; body < 2; ++body) {
      if (is_outside(body)) {
        open_.bound = floor_;
        if (record_ != nullptr) record_->set_outside(open_.node, body);
        return;
      }
    }
    if (record_ == nullptr) bound_by_voids();
    if (open_.bound <= enough_) return;
    list_patches();
    const double bound = solve() + rounding_of_sum() + cell_.error;
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
    return bodies_.widened(box_, open_.bound + bodies_.less(body) + 2 * bodies_.rounding());
  }

  // The patches of the body near the cell, once they are listed, and those that may have a point in its interior, unless
  // they are very many.
  const PatchList& near_to(int body) const { return (*open_.near)[static_cast<std::size_t>(body)]; }
  const PatchList& met_by(int body) const { return *open_.met[static_cast<std::size_t>(body)]; }

  // Whether the body has no point inside the cell.
  bool is_outside(int body) {
    const auto side = static_cast<std::size_t>(body);
    if (open_.inside[side]) return false;
    if (!open_.met[side]) {
      PatchList near = bodies_.patches_near(body, box_, budget_, nullptr);
      if (bodies_.may_be_part(near)) {
        if (std::any_of(near.begin(), near.end(), [&](std::uint32_t i) { return may_meet(body, i); })) return false;
        near = bodies_.patches_at(body, box_, budget_);
      }
      open_.met[side] = std::move(near);
    }
    PatchList& met = *open_.met[side];
    budget_.spend(kFilterWork * met.size());
    std::erase_if(met, [&](std::uint32_t i) { return !may_meet(body, i); });
    if (!met.empty()) return false;
    if (is_void_at_middle(body)) return true;
    open_.inside[side] = bodies_.is_inside(body, middle_, budget_);
    return false;
  }

  bool is_void_at_middle(int body) {
    auto& known = void_at_middle_[static_cast<std::size_t>(body)];
    if (!known) known = bodies_.is_outside(body, middle_, budget_);
    return *known;
  }

  // Whether many patches run through the cell around a point outside of the body: no point is deeper than it is far from
  // there. What is near to it follows from the parts of the cell.
  bool is_crowded() {
    for (int body = 0; body < 2; ++body) {
      const auto& met = open_.met[static_cast<std::size_t>(body)];
      if (met && met->size() <= kCrowd) continue;
      if (bodies_.patches_at(body, box_, budget_, kCrowd + 1).size() <= kCrowd || !is_void_at_middle(body)) continue;
      open_.bound = std::fmin(open_.bound, radius_ + cell_.error + bodies_.rounding() - bodies_.less(body));
      return true;
    }
    return false;
  }

  // Lists the patches near enough to matter.
  void list_patches() {
    auto lists = std::make_shared<PatchLists>();
    for (int body = 0; body < 2; ++body) {
      const PatchList* known = open_.near ? &near_to(body) : nullptr;
      PatchList& list = (*lists)[static_cast<std::size_t>(body)];
      list = bodies_.patches_near(body, reach_of(body), budget_, known);
      if (bodies_.may_be_part(list)) continue;
      for (const std::uint32_t i : list) near_boxes_[static_cast<std::size_t>(body)].push_back(bodies_.box(body, i));
    }
    open_.near = std::move(lists);
  }

  // Around a point outside of either body.
  void bound_by_voids() {
    for (int body = 0; body < 2; ++body) {
      const auto side = static_cast<std::size_t>(body);
      if (!open_.met[side] || met_by(body).empty() || met_by(body).size() > kCrowd) continue;
      const auto hollow = hollow_of(body);
      if (!hollow) continue;
      const CellVoid here{cell_, body, met_by(body), *hollow, open_.near ? &(*open_.near)[1 - side] : nullptr};
      const double bound = bound_around(here, bodies_, kWorthwhile * std::fmin(open_.bound, radius_), budget_);
      open_.bound = std::fmin(open_.bound, bound);
    }
  }

  // A point of the cell outside of the body: its middle, or one a little in front of the nearest patch.
  std::optional<Vec3> hollow_of(int body) {
    if (is_void_at_middle(body)) return middle_;
    const ConvexPatches& patches = bodies_.patches(body);
    Vec3 front;
    double least = INFINITY;
    for (const std::uint32_t i : met_by(body)) {
      const Vec3 on = patches.nearest(patches.patches[i], middle_);
      if (norm(on - middle_) >= least) continue;
      least = norm(on - middle_);
      front = on + patches.patches[i].normal * (kInFront * radius_);
    }
    const double close = cell_.error + bodies_.rounding();
    for (const HalfSpace& side : cell_.sides) {
      if (dot(side.normal, front) > side.height - close) return std::nullopt;
    }
    return bodies_.is_outside(body, front, budget_) ? std::optional(front) : std::nullopt;
  }

  // Whether the patch may have a point in the interior of the cell.
  bool may_meet(int body, std::uint32_t number) const {
    if (!meet(bodies_.box(body, number), box_)) return false;
    const Patch& patch = bodies_.patch(body, number);
    budget_.spend(kDistanceWork);
    const double close = cell_.error + bodies_.rounding();
    if (bodies_.patches(body).distance(patch, middle_) > radius_ + patch.slack + close) return false;
    const Vec3* outline = bodies_.patches(body).outlines.data() + patch.first;
    for (const HalfSpace& side : cell_.sides) {
      double least = INFINITY;
      for (std::uint32_t i = 0; i < patch.count; ++i) least = smaller(least, dot(side.normal, outline[i]));
      // Along an axis nothing is rounded.
      const bool along_axis = (side.normal.x != 0) + (side.normal.y != 0) + (side.normal.z != 0) == 1;
      if (least - patch.slack >= side.height + (along_axis ? 0 : close)) return false;
    }
    Range heights;
    for (const Cell::Corner& corner : cell_.corners) heights.include(dot(patch.normal, corner.at - bodies_.patches(body).origin(patch)));
    const double slack = patch.slack + close;
    return !(heights.low > slack || heights.high < -slack);
  }

  double solve() {
    // A cut leaves the cell by no more than that.
    const double diagonal = norm(box_.size()) + bodies_.rounding();
    floor_of_game_ = floor_ - diagonal;
    game_.emplace(cell_.corners.size(), floor_of_game_, diagonal + open_.bound - floor_);
    for (const Column& column : open_.columns) add(column.plane ? column : best_column(column.body, column.patch));
    // Where the point is as deep as the bound from before, nothing is nearer, and there is no game to play.
    if (columns_.empty() && !add_nearest(point_)) return INFINITY;
    double bound = INFINITY;
    while (true) {
      play();
      const double shown = proven();
      if (record_ != nullptr && shown < bound) keep_terms();
      bound = std::fmin(bound, shown);
      if (bound <= enough_) return bound;
      const double before = depth_;
      if (!add_nearest(point_)) return bound;
      if (columns_.size() >= (only_planes_ ? kMostPlanes : kMostColumns)) return bound;
      if (!only_planes_ && before < INFINITY && bound - depth_ < kHopeless * (bound - enough_)) return bound;
    }
  }

  // Solves the game.
  void play() {
    game_->solve();
    budget_.spend(kGameWork * cell_.corners.size());
    shares_ = game_->row_weights();
    point_ = {};
    for (std::size_t k = 0; k < cell_.corners.size(); ++k) point_ = point_ + cell_.corners[k].at * shares_[k];
  }

  double rounding_of_sum() const { return bodies_.rounding() * (1 + kSumRounding * static_cast<double>(columns_.size() + 3)); }

  // The largest weighted sum at a corner.
  double proven() const {
    const std::vector<double>& weights = game_->column_weights();
    double total = 0, bound = -INFINITY;
    for (const double weight : weights) total += weight;
    if (!(total > 0)) return INFINITY;
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
    budget_.spend(kDistanceWork * cell_.corners.size());
    game_->add({values_.data() + values_.size() - cell_.corners.size(), cell_.corners.size()});
    return true;
  }

  // The plane of the patch, where that will do, or its distance.
  Column best_column(int body, std::uint32_t patch) const {
    const PatchList& near = near_to(body);
    const auto plane = bodies_.plane_column(body, patch, reach_of(body), near, kPlaneTolerance * open_.bound, budget_);
    return plane ? *plane : Column{patch, false, body, 0, 1};
  }

  // The patch nearest to a point of the cell; of several, the one that p is farthest in front of.
  Nearest nearest(int body, Vec3 p) const {
    Nearest best;
    double front = -INFINITY;
    const Aabb at{p, p};
    const double tie = bodies_.rounding();
    const auto compare = [&](std::uint32_t i, const Aabb& box) {
      const double reach = best.depth + tie;
      if (box_distance_squared(at, box) > reach * reach) return;
      budget_.spend(kDistanceWork);
      const Patch& patch = bodies_.patch(body, i);
      const double distance = bodies_.patches(body).distance(patch, p);
      if (distance > best.depth + tie) return;
      const double in_front = dot(patch.normal, p - bodies_.patches(body).origin(patch));
      if (distance < best.depth - tie || in_front > front) {
        front = in_front;
        best.patch = i;
      }
      best.depth = smaller(best.depth, distance);
    };
    // What was near to other points of the cell is likely to be near to this one.
    for (const Column& column : columns_) {
      if (column.body == body) compare(column.patch, bodies_.box(body, column.patch));
    }
    const PatchList& near = near_to(body);
    if (!bodies_.may_be_part(near)) {
      budget_.spend(kFilterWork * near.size());
      for (std::size_t k = 0; k < near.size(); ++k) compare(near[k], near_boxes_[static_cast<std::size_t>(body)][k]);
    } else {
      const Surface& surface = bodies_.surface(body);
      std::optional<NearestPoint> known;
      if (best.depth < INFINITY) known = NearestPoint{best.depth, p, bodies_.patches(body).triangles[bodies_.patch(body, best.patch).first_triangle]};
      const double reach = nearest_point(surface, p, &budget_, known ? &*known : nullptr).distance + 2 * tie;
      const auto is_near = [&](const Aabb& box) { return box_distance_squared(at, box) <= reach * reach; };
      visit_where(surface.bvh, surface.mesh, is_near, [&](std::uint32_t t) {
        const std::uint32_t i = bodies_.patches(body).patch_of[t];
        if (i != kNoIndex) compare(i, bodies_.box(body, i));
        return true;
      }, &budget_);
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

  // Where the cell is split: along the void that the game's point lies in, or where the gap is.
  void choose_cut() {
    if (outside_ >= 0 && open_.met[static_cast<std::size_t>(outside_)]) {
      const double layer = std::fmax(kLayer * enough_, 4 * (cell_.error + bodies_.rounding()));
      open_.cut = cut_off_void(cell_, bodies_.patches(outside_), met_by(outside_), point_, layer, budget_);
    }
    if (!open_.cut) open_.cut = cut_at_gap(gap(), kWorthCut * (open_.bound - enough_));
  }

  // What makes the bound larger than the depth of the game's point: columns that are not linear, those that the bound rests
  // on and the one that is the depth of that point.
  CellGap gap() const {
    CellGap gap{bodies_, axes_, cell_, {}, shares_, point_, budget_};
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const Column& column = columns_[c];
      const Nearest& nearest = nearest_[static_cast<std::size_t>(column.body)];
      const bool is_depth = nearest.depth < INFINITY && nearest.depth <= depth_ && nearest.patch == column.patch;
      const double weight = game_->column_weights()[c] + (is_depth ? kNearestWeight : 0);
      if (!column.plane && weight > 0) gap.terms.push_back({column, weight});
    }
    return gap;
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

  const TwoBodies& bodies_;
  const Mat3& axes_;
  OpenCell& open_;
  const Cell& cell_;
  double best_, enough_;
  const Consider& consider_;
  ThicknessRecord* record_;
  Budget& budget_;
  Aabb box_;
  double floor_ = 0, floor_of_game_ = 0;
  Vec3 middle_;        // a point of the cell
  double radius_ = 0;  // no point of it is farther from there
  std::array<std::optional<bool>, 2> void_at_middle_;
  std::array<std::vector<Aabb>, 2> near_boxes_;  // of near_to() a body, if these are all: each point is held against them
  std::optional<MatrixGame> game_;
  std::vector<Column> columns_;
  std::vector<double> values_;  // of each column at all corners
  std::vector<Term> terms_;     // of the least sum, for the record
  bool only_planes_ = true;
  // Where the game's other player expects the deepest point, and its shares of the corners; the middle before the game.
  Vec3 point_;
  std::vector<double> shares_;
  std::array<Nearest, 2> nearest_;
  double depth_ = INFINITY;  // of that point, if it is inside both
  int outside_ = -1;
};

}  // namespace

void bound_cell(const TwoBodies& bodies, const Mat3& axes, OpenCell& open, double best, double enough, const Consider& consider,
                ThicknessRecord* record, Budget& budget) {
  CellBound(bodies, axes, open, best, enough, consider, record, budget).run();
}

}  // namespace satcheck
