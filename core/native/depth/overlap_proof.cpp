// Two solids: convex regions inside both, grown about a common point. Any two bodies: a pair of triangles that
// cross and on all of which the bodies end, for beside such a crossing both have material.
#include "depth/overlap_proof.hpp"

#include <utility>
#include <vector>

#include "depth/inner_region.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh_pair/boundary_contact.hpp"
#include "mesh_pair/common_point.hpp"

namespace satcheck {
namespace {

// Measured, in nanoseconds: a box or triangle that a growing region visits, a query of the climb to a
// common point, a sum of vertices that goes into the hull of a set.
constexpr std::uint64_t kVisitWork = 100, kQueryWork = 5000, kSumWork = 250;

class Proof {
 public:
  Proof(const Surface& a, const Surface& b, Vec3 t) : a_(a), b_(b), t_(t) {}

  OverlapProof take() { return std::move(result_); }

  // Of the sets that two metrics a side give, the one that holds t the deepest.
  void by_regions(const Surface& moved, const MeshRelation& relation) {
    if (!a_.solid || !b_.solid) return;
    std::size_t queries = 0, visits = 0;
    const auto common = common_point(moved, b_, relation, queries);
    if (common) {
      const std::vector<InnerRegion> in_a = regions(a_, common->point - t_, visits);
      const std::vector<InnerRegion> in_b = regions(b_, common->point, visits);
      for (const InnerRegion& p : in_a) {
        for (const InnerRegion& q : in_b) keep_deepest(p.vertices, q.vertices);
      }
    }
    result_.work += kQueryWork * queries + kVisitWork * visits;
  }

  void by_triangles(const MeshRelation& relation) {
    if (relation.triangle_a == kNoTriangle || relation.triangle_b == kNoTriangle) return;
    if (!is_plain_boundary(a_, relation.triangle_a) || !is_plain_boundary(b_, relation.triangle_b)) return;
    const Corners p = corners(a_.mesh, relation.triangle_a), q = corners(b_.mesh, relation.triangle_b);
    keep_deepest({p.begin(), p.end()}, {q.begin(), q.end()});
  }

 private:
  static std::vector<InnerRegion> regions(const Surface& solid, Vec3 seed, std::size_t& visits) {
    std::vector<InnerRegion> found;
    if (auto round = grow_inner_region(solid, seed, {}, visits)) {
      auto spread = grow_inner_region(solid, seed, metric_of(*round), visits);
      found.push_back(std::move(*round));
      if (spread) found.push_back(std::move(*spread));
    }
    return found;
  }

  void keep_deepest(const std::vector<Vec3>& part_of_a, const std::vector<Vec3>& part_of_b) {
    result_.work += kSumWork * part_of_a.size() * part_of_b.size();
    ForbiddenSet set = forbidden_set(part_of_a, part_of_b);
    const double depth = set.exit(t_).depth;
    if (!(depth > depth_)) return;
    depth_ = depth;
    result_.set = std::move(set);
  }

  const Surface& a_;
  const Surface& b_;
  Vec3 t_;
  double depth_ = 0;
  OverlapProof result_;
};

}  // namespace

OverlapProof prove_overlap(const Surface& a, const Surface& moved, const Surface& b, Vec3 t,
                           const MeshRelation& relation) {
  Proof proof(a, b, t);
  proof.by_regions(moved, relation);
  proof.by_triangles(relation);
  return proof.take();
}

}  // namespace satcheck
