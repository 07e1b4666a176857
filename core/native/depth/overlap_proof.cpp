// Two solids: convex regions inside both, grown about a common point. Any two bodies: a pair of triangles that
// cross and on all of which the bodies end, for beside such a crossing both have material.
#include "depth/overlap_proof.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "depth/inner_region.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh_pair/boundary_contact.hpp"
#include "mesh_pair/common_point.hpp"
#include "mesh_pair/traversal.hpp"

namespace satcheck {
namespace {

// Crossings that are tried, about.
constexpr std::size_t kPockets = 8;
// A crossing this near to a common point, in its depths, is taken to belong to the same overlap.
constexpr double kNear = 2;

class Proof {
 public:
  Proof(const Surface& a, const Surface& b, Vec3 t) : a_(a), b_(b), t_(t) {}

  ForbiddenSet take() { return std::move(set_); }

  // Of the sets that two metrics a side give, the one that holds t the deepest.
  void by_regions(const Surface& moved, const MeshRelation& relation, Overlaps overlaps) {
    if (!a_.solid || !b_.solid) return;
    // Beside a crossing in a last digit no common point may be found, and yet the bodies overlap elsewhere.
    std::optional<CommonPoint> common = common_point(moved, b_, relation);
    if (!common || overlaps == Overlaps::thickest) common = thickest(common, moved, relation);
    if (common) {
      const std::vector<InnerRegion> in_a = regions(a_, common->point - t_);
      const std::vector<InnerRegion> in_b = regions(b_, common->point);
      for (const InnerRegion& p : in_a) {
        for (const InnerRegion& q : in_b) keep_deepest(p.vertices, q.vertices);
      }
    }
  }

  void by_triangles(const MeshRelation& relation) {
    if (relation.triangle_a == kNoTriangle || relation.triangle_b == kNoTriangle) return;
    if (!is_plain_boundary(a_, relation.triangle_a) || !is_plain_boundary(b_, relation.triangle_b)) return;
    const Corners p = corners(a_.mesh, relation.triangle_a), q = corners(b_.mesh, relation.triangle_b);
    keep_deepest({p.begin(), p.end()}, {q.begin(), q.end()});
  }

 private:
  // The deepest common point of some: the one that the relation led to, and those beside more crossings.
  std::optional<CommonPoint> thickest(std::optional<CommonPoint> deepest, const Surface& moved,
                                      const MeshRelation& relation) const {
    if (relation.triangle_a == kNoTriangle || relation.triangle_b == kNoTriangle) return deepest;
    std::vector<CommonPoint> tried;
    if (deepest) tried.push_back(*deepest);
    const std::vector<ContactPair> contacts = find_contacts(moved, b_, AtCrossing::go_on).contacts;
    const std::size_t stride = std::max<std::size_t>(1, contacts.size() / kPockets);
    for (std::size_t k = 0; k < contacts.size(); k += stride) {
      const Corners p = corners(moved.mesh, contacts[k].a), q = corners(b_.mesh, contacts[k].b);
      if (classify(p, q) != TriangleContact::crossing) continue;
      MeshRelation here;
      here.relation = Relation::penetrating;
      here.triangle_a = contacts[k].a;
      here.triangle_b = contacts[k].b;
      here.point = crossing_point(p, q);
      const auto is_known = [&](const CommonPoint& c) { return norm(c.point - *here.point) <= kNear * c.depth; };
      if (std::any_of(tried.begin(), tried.end(), is_known)) continue;
      const auto common = common_point(moved, b_, here);
      if (!common) continue;
      tried.push_back(*common);
      if (!deepest || common->depth > deepest->depth) deepest = common;
    }
    return deepest;
  }

  static std::vector<InnerRegion> regions(const Surface& solid, Vec3 seed) {
    std::vector<InnerRegion> found;
    if (auto round = grow_inner_region(solid, seed, {})) {
      auto spread = grow_inner_region(solid, seed, metric_of(*round));
      found.push_back(std::move(*round));
      if (spread) found.push_back(std::move(*spread));
    }
    return found;
  }

  void keep_deepest(const std::vector<Vec3>& part_of_a, const std::vector<Vec3>& part_of_b) {
    ForbiddenSet set = forbidden_set(part_of_a, part_of_b);
    const double depth = set.exit(t_).depth;
    if (!(depth > depth_)) return;
    depth_ = depth;
    set_ = std::move(set);
  }

  const Surface& a_;
  const Surface& b_;
  Vec3 t_;
  double depth_ = 0;
  ForbiddenSet set_;
};

}  // namespace

ForbiddenSet prove_overlap(const Surface& a, const Surface& moved, const Surface& b, Vec3 t,
                           const MeshRelation& relation, Overlaps overlaps) {
  Proof proof(a, b, t);
  proof.by_regions(moved, relation, overlaps);
  proof.by_triangles(relation);
  return proof.take();
}

}  // namespace satcheck
