// For two solids: convex regions inside both, grown about a common point. For any two bodies: a pair of triangles that
// cross, because every triangle bounds material, lies within it, or is a sheet; or a triangle of one body and a region
// inside the other. For an open body only material that does not depend on fills counts.
#include "depth/overlap_proof.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "depth/inner_region.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/boundary.hpp"
#include "mesh_pair/common_point.hpp"
#include "mesh_pair/traversal.hpp"

namespace satcheck {
namespace {

// About how many crossings are tried.
constexpr std::size_t kPockets = 8;
// Another set is made if t may be deeper in it by this share.
constexpr double kWorthwhile = 1.0 / 64;
// The most steps of listing all pairs in contact, about half a second.
constexpr std::uint64_t kListingWork = 500'000'000;
// A crossing this near to a common point, in units of its depth, counts as part of the same overlap.
constexpr double kNear = 2;

// A body with its closed surface.
class Body {
 public:
  Body(const Surface& surface, Budget& budget)
      : surface_(surface), closing_(surface.solid ? nullptr : closing_of(surface, OpenParts::filled, &budget)) {}

  const Surface& closed() const { return closing_ ? *closing_->surface : surface_; }
  const Surface& walled() const { return closing_ ? *walled_surface(surface_, OpenParts::filled) : surface_; }

  // Whether the point is outside of the hulls of all holes.
  bool is_certain_at(Vec3 p, Budget& budget) const {
    if (!closing_) return true;
    return std::all_of(closing_->hulls.begin(), closing_->hulls.end(),
                       [&](const Surface& hull) { return winding_number(hull, p, &budget) == 0; });
  }

 private:
  const Surface& surface_;
  std::shared_ptr<const Closing> closing_;
};

class Proof {
 public:
  Proof(const Surface& a, const Surface& b, Vec3 t, Budget& budget) : a_(a), b_(b), t_(t), budget_(budget) {}

  bool empty() const { return proof_.set.empty(); }
  OverlapProof take() { return std::move(proof_); }

  // Two metrics for each body give several sets. Takes the one in which t is deepest.
  void by_regions(const Surface& moved, const MeshRelation& relation, Overlaps overlaps) {
    const Body a(a_, budget_), b(b_, budget_), moved_a(moved, budget_);
    const Surface &closed_a = moved_a.closed(), &closed_b = b.closed();
    // Near a crossing that is only a last digit deep, no common point may be found, although the bodies overlap
    // elsewhere.
    std::optional<CommonPoint> common = common_point(closed_a, closed_b, relation, INFINITY, &budget_);
    if (!common || overlaps == Overlaps::thickest) common = thickest(common, closed_a, closed_b, relation);
    if (common && a.is_certain_at(common->point - t_, budget_) && b.is_certain_at(common->point, budget_)) {
      const std::vector<InnerRegion> in_a = regions(a.walled(), common->point - t_);
      const std::vector<InnerRegion> in_b = regions(b.walled(), common->point);
      for (const InnerRegion& p : in_a) {
        for (const InnerRegion& q : in_b) {
          if (keep_deepest(p.vertices, q.vertices)) proof_.regions = {p, q};
        }
      }
    }
  }

  // A triangle of one body inside the other. For a sheet this is the only kind of overlap.
  void by_triangle_within(const MeshRelation& relation) {
    if ((relation.triangle_a == kNoIndex) == (relation.triangle_b == kNoIndex)) return;
    const bool is_of_a = relation.triangle_a != kNoIndex;
    const Corners c = is_of_a ? corners(a_.mesh, relation.triangle_a) : corners(b_.mesh, relation.triangle_b);
    const std::vector<Vec3> triangle(c.begin(), c.end());
    const Vec3 middle = (c[0] + c[1] + c[2]) * (1.0 / 3);
    const Vec3 seed = is_of_a ? middle + t_ : middle - t_;
    const Body other(is_of_a ? b_ : a_, budget_);
    if (!other.is_certain_at(seed, budget_)) return;
    for (const InnerRegion& region : regions(other.walled(), seed)) {
      is_of_a ? keep_deepest(triangle, region.vertices) : keep_deepest(region.vertices, triangle);
    }
  }

  void by_triangles(const MeshRelation& relation) {
    if (relation.triangle_a == kNoIndex || relation.triangle_b == kNoIndex) return;
    const Corners p = corners(a_.mesh, relation.triangle_a), q = corners(b_.mesh, relation.triangle_b);
    keep_deepest({p.begin(), p.end()}, {q.begin(), q.end()});
  }

 private:
  // The deepest of several common points: the one from the relation, and those near other crossings.
  std::optional<CommonPoint> thickest(std::optional<CommonPoint> deepest, const Surface& moved, const Surface& b,
                                      const MeshRelation& relation) const {
    if (relation.triangle_a == kNoIndex || relation.triangle_b == kNoIndex) return deepest;
    std::vector<CommonPoint> tried;
    if (deepest) tried.push_back(*deepest);
    const std::vector<ContactPair> contacts = contacts_with(moved, b);
    const std::size_t stride = std::max<std::size_t>(1, contacts.size() / kPockets);
    for (std::size_t k = 0; k < contacts.size(); k += stride) {
      const Corners p = corners(moved.mesh, contacts[k].a), q = corners(b.mesh, contacts[k].b);
      if (classify(p, q, &budget_) != TriangleContact::crossing) continue;
      MeshRelation here;
      here.relation = Relation::penetrating;
      here.triangle_a = contacts[k].a;
      here.triangle_b = contacts[k].b;
      here.point = crossing_point(p, q);
      const auto is_known = [&](const CommonPoint& c) { return norm(c.point - *here.point) <= kNear * c.depth; };
      if (std::any_of(tried.begin(), tried.end(), is_known)) continue;
      const auto common = common_point(moved, b, here, INFINITY, &budget_);
      if (!common) continue;
      tried.push_back(*common);
      if (!deepest || common->depth > deepest->depth) deepest = common;
    }
    return deepest;
  }

  // All pairs in contact; none if they are too many. The budget of the search does not stop the list.
  std::vector<ContactPair> contacts_with(const Surface& moved, const Surface& b) const {
    Budget listing = Budget::that_stops(kListingWork, [&](const SearchState& state) { budget_.tell_again(state.work); });
    std::vector<ContactPair> contacts;
    try {
      contacts = find_contacts(moved, b, AtCrossing::go_on, &listing).contacts;
    } catch (const BudgetSpent&) {
      // Other crossings only make the proof stronger.
    }
    budget_.spend(listing.spent());
    return contacts;
  }

  std::vector<InnerRegion> regions(const Surface& solid, Vec3 seed) const {
    std::vector<InnerRegion> found;
    if (auto round = grow_inner_region(solid, seed, {}, &budget_)) {
      auto spread = grow_inner_region(solid, seed, metric_of(round->vertices), &budget_);
      found.push_back(std::move(*round));
      if (spread) found.push_back(std::move(*spread));
    }
    return found;
  }

  // Whether t is deeper in the difference of these parts.
  bool keep_deepest(const std::vector<Vec3>& part_of_a, const std::vector<Vec3>& part_of_b) {
    if (!may_be_deeper(part_of_a, part_of_b)) return false;
    ForbiddenSet set = forbidden_set(part_of_a, part_of_b, &budget_);
    const double depth = set.exit(t_).depth;
    if (!(depth > depth_)) return false;
    depth_ = depth;
    proof_.set = std::move(set);
    return true;
  }

  // Whether t may be deeper in the difference of these parts than in the best set so far. It is no deeper than behind any
  // plane that supports the difference, and those along the facets of the best set are likely to be near to t.
  bool may_be_deeper(const std::vector<Vec3>& part_of_a, const std::vector<Vec3>& part_of_b) const {
    const ForbiddenSet& best = proof_.set;
    return std::none_of(best.normal.begin(), best.normal.end(), [&](Vec3 n) {
      return highest(part_of_b, n) + highest(part_of_a, -n) - dot(n, t_) <= depth_ * (1 + kWorthwhile);
    });
  }

  static double highest(const std::vector<Vec3>& points, Vec3 n) {
    double most = -INFINITY;
    for (const Vec3 p : points) most = larger(most, dot(n, p));
    return most;
  }

  const Surface& a_;
  const Surface& b_;
  Vec3 t_;
  Budget& budget_;
  double depth_ = 0;
  OverlapProof proof_;
};

}  // namespace

OverlapProof prove_overlap(const Surface& a, const Surface& moved, const Surface& b, Vec3 t,
                           const MeshRelation& relation, Overlaps overlaps, bool regions_alone, Budget& budget) {
  Proof proof(a, b, t, budget);
  proof.by_regions(moved, relation, overlaps);
  if (regions_alone) return proof.take();
  proof.by_triangles(relation);
  if (proof.empty()) proof.by_triangle_within(relation);
  return proof.take();
}

}  // namespace satcheck
