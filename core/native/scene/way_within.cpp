#include "scene/way_within.hpp"

#include <algorithm>

#include "base/numeric_range.hpp"
#include "base/tolerances.hpp"
#include "convex/narrow_phase.hpp"
#include "mesh/topology.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "mesh_pair/moved_surface.hpp"
#include "scene/touch_proof.hpp"

namespace satcheck {
namespace {

constexpr int kWalls = 3;

// A moved again and again, without a tree being built.
class Trials {
 public:
  Trials(const Surface& a, const Surface& b) : still_(a), moved_(a), b_(b) {}

  MeshRelation after(Vec3 move) {
    const Surface& moved = moved_.at(move);
    require_in_range(moved.mesh.vertices, "moved vertex");
    if (is_welded(moved.mesh)) return mesh_relation(moved, b_);
    return mesh_relation(make_surface(moved.mesh, still_.solid), b_);
  }

 private:
  const Surface& still_;
  MovedSurface moved_;
  const Surface& b_;
};

bool is_free(const MeshRelation& found) {
  return found.proven && (found.relation == Relation::separated || found.relation == Relation::touching);
}

class Search {
 public:
  Search(PlacedGeometry& a, PlacedGeometry& b, double tolerance)
      : a_(a), b_(b), of_a_(a.surface()), of_b_(b.surface()), trials_(*of_a_, *of_b_), tolerance_(tolerance) {}

  std::optional<Vec3> out_of_hulls() {
    const PairResult found = check_pair(*a_.hull_shape(), {}, *b_.hull_shape(), {}, Query::depth);
    if (!found.has_distance || (found.outcome != Outcome::penetrating && found.outcome != Outcome::touching)) return {};
    const double upper = found.outcome == Outcome::penetrating ? -found.lower : 0.0;
    double largest = 0;
    for (const Aabb& box : {a_.bounds(), b_.bounds()}) largest = std::max({largest, max_abs(box.min), max_abs(box.max)});
    for (const double length : {upper, upper + chain_rounding(largest)}) {
      const Vec3 move = found.normal * -length;
      if (0 < length && length <= tolerance_ && is_free(trials_.after(move))) return move;
    }
    return {};
  }

  // Depth first: a step off the crossing triangles, then off those that are then crossed.
  std::optional<Vec3> off(ContactPair crossing, Vec3 at = {}, int walls = kWalls) {
    for (const Vec3 away : ways_off(crossing)) {
      const Vec3 there = at + away * (tolerance_ / kWalls);
      const MeshRelation found = trials_.after(there);
      if (is_free(found)) return there;
      if (found.triangle_a == kNoTriangle || found.triangle_b == kNoTriangle) continue;
      deepest_ = std::max(deepest_, crossing_depth(*of_a_, *of_b_, found.triangle_a, found.triangle_b));
      if (deepest_ > tolerance_) return {};
      if (walls == 1) continue;
      if (const auto further = off({found.triangle_a, found.triangle_b}, there, walls - 1)) return further;
    }
    return {};
  }

  double deepest() const { return deepest_; }

 private:
  // Unit directions for A: along B's outward normal, against its own; both ways if not solid.
  std::vector<Vec3> ways_off(ContactPair crossing) const {
    std::vector<Vec3> ways;
    const auto append = [&](const Surface& surface, std::uint32_t triangle, double sign) {
      const auto c = corners(surface.mesh, triangle);
      const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
      if (normal == Vec3{}) return;
      const Vec3 unit = normal * (1 / std::hypot(normal.x, normal.y, normal.z));
      ways.push_back(unit * sign);
      if (!surface.solid) ways.push_back(unit * -sign);
    };
    append(*of_b_, crossing.b, 1);
    append(*of_a_, crossing.a, -1);
    return ways;
  }

  PlacedGeometry &a_, &b_;
  std::shared_ptr<Surface> of_a_, of_b_;
  Trials trials_;
  double tolerance_, deepest_ = 0;
};

}  // namespace

WayWithin find_way_within(PlacedGeometry& a, PlacedGeometry& b, double tolerance, std::optional<ContactPair> crossing) {
  Search search(a, b, tolerance);
  std::optional<Vec3> move = search.out_of_hulls();
  if (!move && crossing) move = search.off(*crossing);
  return {move, search.deepest()};
}

}  // namespace satcheck
