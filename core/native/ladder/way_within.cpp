#include "ladder/way_within.hpp"

#include <algorithm>

#include "base/numeric_range.hpp"
#include "base/rounding.hpp"
#include "convex/narrow_phase.hpp"
#include "convex/exact_depth.hpp"
#include "mesh/topology.hpp"
#include "mesh/transform.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "mesh_pair/moved_surface.hpp"
#include "ladder/touch_proof.hpp"

namespace satcheck {
namespace {

constexpr int kWalls = 3;

// Measured steps of moving a triangle with its share of the tree.
constexpr std::uint64_t kMoveWork = 50;

// The computed length of a unit direction times the tolerance exceeds the tolerance by no more than this factor.
constexpr double kToRounding = 1 + 16 * kUnitRoundoff;

// Moves A many times without rebuilding its tree.
class Trials {
 public:
  Trials(const Surface& a, const Surface& b, Budget& budget) : still_(a), moved_(a), b_(b), budget_(budget) {}

  MeshRelation after(Vec3 move) {
    budget_.spend(kMoveWork * still_.mesh.triangles.size());
    const Surface& moved = moved_.at(move, &budget_);
    require_in_range(moved.mesh.vertices, "moved vertex");
    if (is_welded(moved.mesh)) return mesh_relation(moved, b_, budget_);
    return mesh_relation(make_surface(moved.mesh, still_.solid), b_, budget_);
  }

 private:
  const Surface& still_;
  MovedSurface moved_;
  const Surface& b_;
  Budget& budget_;
};

// A translation that frees A also frees B in the opposite direction, up to rounding. A way out has to do both, so that
// the order of the bodies does not matter.
class Search {
 public:
  Search(PlacedGeometry& a, PlacedGeometry& b, double tolerance, Budget& budget)
      : a_(a), b_(b), of_a_(a.surface()), of_b_(b.surface()), budget_(budget), trials_(*of_a_, *of_b_, budget), tolerance_(tolerance) {}

  std::optional<Vec3> out_of_hulls() {
    const PairResult found = check_pair(*a_.hull_shape(), {}, *b_.hull_shape(), {}, Query::depth);
    if (!found.has_distance || (found.outcome != Outcome::penetrating && found.outcome != Outcome::touching)) return {};
    const double upper = found.outcome == Outcome::penetrating ? -found.lower : 0.0;
    hulls_are_within_ = upper <= tolerance_ || (-found.upper <= tolerance_ && compare_hulls() >= 0);
    const double largest = larger(a_.bounds().largest_coordinate(), b_.bounds().largest_coordinate());
    for (const double length : {upper, upper + chain_rounding(largest), tolerance_}) {
      if (!(0 < length && length <= tolerance_)) continue;
      if (const auto move = way_out(found.normal * -length)) return move;
    }
    return {};
  }

  // Depth first: a step away from the crossing triangles, then from those that cross after the step.
  std::optional<Vec3> off(ContactPair crossing, Vec3 at = {}, int walls = kWalls) {
    if (is_deeper_at(crossing)) return {};
    for (const Vec3 away : ways_off(crossing)) {
      const Vec3 there = at + away * (tolerance_ / kWalls);
      const MeshRelation found = trials_.after(there);
      if (found.is_free()) {
        if (const auto move = way_out(there)) return move;
      }
      if (found.triangle_a == kNoIndex || found.triangle_b == kNoIndex) continue;
      const ContactPair next{found.triangle_a, found.triangle_b};
      if (is_deeper_at(next)) return {};
      if (walls == 1) continue;
      if (const auto further = off(next, there, walls - 1)) return further;
      if (deeper_) return {};
    }
    return {};
  }

  // One step of the whole band.
  std::optional<Vec3> straight_off(ContactPair crossing) {
    for (const Vec3 away : ways_off(crossing)) {
      if (const auto move = way_out(away * tolerance_)) return move;
    }
    return {};
  }

  bool is_deeper() const { return deeper_; }
  WayWithin found(std::optional<Vec3> move) const {
    const BandSide side = move || hulls_are_within_ ? BandSide::within
                          : deeper_                 ? BandSide::deeper
                          : hidden_                 ? BandSide::hidden
                                                    : BandSide::open;
    return {move, deepest_, side};
  }

 private:
  // Whether these triangles prove a depth beyond the band, for the bodies as placed.
  bool is_deeper_at(ContactPair crossing) {
    deepest_ = std::max(deepest_, crossing_depth(*of_a_, *of_b_, crossing.a, crossing.b));
    deeper_ = deeper_ || deepest_ > tolerance_ || crosses_deeper(*of_a_, *of_b_, crossing.a, crossing.b, tolerance_);
    return deeper_;
  }

  int compare_hulls() const {
    return compare_signed_distance(*a_.hull_shape(), {}, *b_.hull_shape(), {}, -tolerance_).value_or(-1);
  }

  // The move, or a nearby one that rounds no coordinate, if it is within the tolerance and frees A.
  std::optional<Vec3> way_out(Vec3 move) {
    for (const Vec3 candidate : {move, on_grid(move)}) {
      const bool is_short = moves_within(of_a_->mesh.vertices, candidate, tolerance_) &&
                            moves_within(of_b_->mesh.vertices, -candidate, tolerance_);
      if (!is_short && (hidden_ || !(scaled_norm(candidate) <= tolerance_ * kToRounding))) {
        continue;
      }
      if (!trials_.after(candidate).is_free() || !Trials(*of_b_, *of_a_, budget_).after(-candidate).is_free()) continue;
      if (is_short) return candidate;
      hidden_ = true;
    }
    return {};
  }

  // Rounds each coordinate to a multiple of the float64 spacing at the largest coordinate.
  Vec3 on_grid(Vec3 move) const {
    const auto round = [](double step, const Aabb& a, const Aabb& b, int axis) {
      const double most = std::max({std::fabs(a.min[axis]), std::fabs(a.max[axis]), std::fabs(b.min[axis]), std::fabs(b.max[axis])});
      return (most + step) - most;
    };
    const Aabb &a = a_.bounds(), &b = b_.bounds();
    return {round(move.x, a, b, 0), round(move.y, a, b, 1), round(move.z, a, b, 2)};
  }

  // Unit directions for A: along B's outward normal, or against A's own; both signs if the body is not solid.
  std::vector<Vec3> ways_off(ContactPair crossing) const {
    std::vector<Vec3> ways;
    const auto append = [&](const Surface& surface, std::uint32_t triangle, double sign) {
      const auto c = corners(surface.mesh, triangle);
      const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
      if (normal == Vec3{}) return;
      const Vec3 unit = normal * (1 / scaled_norm(normal));
      ways.push_back(unit * sign);
      if (!surface.solid) ways.push_back(unit * -sign);
    };
    append(*of_b_, crossing.b, 1);
    append(*of_a_, crossing.a, -1);
    return ways;
  }

  PlacedGeometry &a_, &b_;
  std::shared_ptr<Surface> of_a_, of_b_;
  Budget& budget_;  // of all trials
  Trials trials_;
  double tolerance_, deepest_ = 0;
  bool deeper_ = false, hidden_ = false, hulls_are_within_ = false;
};

WayWithin way_in_order(PlacedGeometry& a, PlacedGeometry& b, double tolerance, std::optional<ContactPair> crossing,
                       Budget& budget) {
  Search search(a, b, tolerance, budget);
  std::optional<Vec3> move;
  try {
    move = search.out_of_hulls();
    if (!move && crossing) move = search.off(*crossing);
    if (!move && crossing && !search.is_deeper()) move = search.straight_off(*crossing);
  } catch (const BudgetSpent&) {
    // What the hulls and the triangles have shown stands.
  }
  return search.found(move);
}

}  // namespace

WayWithin find_way_within(PlacedGeometry& a, PlacedGeometry& b, double tolerance, std::optional<ContactPair> crossing,
                          Budget& budget) {
  if (comes_before(*a.surface(), *b.surface())) return way_in_order(a, b, tolerance, crossing, budget);
  if (crossing) std::swap(crossing->a, crossing->b);
  WayWithin found = way_in_order(b, a, tolerance, crossing, budget);
  if (found.move) found.move = Vec3{} - *found.move;  // no negative zeros
  return found;
}

}  // namespace satcheck
