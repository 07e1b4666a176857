// Method: branch and bound over boxes in the space of translations, least norm first. A box is dropped when
// one convex set of translations that are proven to leave an overlap (overlap_proof.hpp) holds all of it,
// or all that is short enough to matter. Where no set holds a point near the box's nearest one, the meshes
// themselves are asked: free, and an upper bound is found; overlapping, and that proves one more set.
#include "depth/depth_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "base/tolerances.hpp"
#include "base/work.hpp"
#include "depth/corner_plane.hpp"
#include "depth/exact_centre.hpp"
#include "depth/forbidden_set.hpp"
#include "depth/overlap_proof.hpp"
#include "depth/translation_box.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "mesh_pair/moved_surface.hpp"
#include "mesh_pair/wall_corner.hpp"

namespace satcheck {
namespace {

// Steps of a plane that a translation is held against, of a box, of a vertex that is moved: measured. And how many of them
// lie between two calls of poll().
constexpr std::uint64_t kPlaneWork = 2, kBoxWork = 300, kVertexWork = 10, kPollWork = 50'000'000;

// Steps out of one set after another until the meshes are free.
constexpr int kStepsOut = 8;
constexpr std::size_t kMostWalls = 24;
// How far beyond the boundary of a set a step leads, so that rounding does not leave it inside: a share of
// the known way out.
constexpr double kBeyond = 1e-10;
// Facets of a set that may cut a box of which other sets cover the rest.
constexpr std::size_t kMostCuts = 4;
// Sets that a point may be moved out of within its box.
constexpr std::size_t kSetsLeft = 24;
// From so many sets on each is made where the bodies overlap the most.
constexpr std::size_t kManySets = 40;
// How much deeper than the others a set has to hold a point to be kept beside them.
constexpr double kDeeper = 2;
// How far into the open, in halves of the box.
constexpr double kIntoTheOpen = 1.0 / 16;
// A way out that ends at a face is shortened to that face where the two agree to this share of it.
constexpr double kSnap = 1e-6;
// Boxes below this share of the known way out lie on a seam of two sets, if no set holds them.
constexpr double kSeam = 1e-5;

// After this part of the work, spheres from this part of the known way out on are scanned for a shorter one.
constexpr std::uint64_t kScanAfter = 8;
constexpr double kSmallestSphere = 64, kSphereRatio = 1.2, kScanStep = 0.05;

// Rounding of the norm of a point.
constexpr double kNormError = 4 * kUnitRoundoff;

// Unit vectors all round: towards the points of a lattice on the surface of a cube.
std::vector<Vec3> ways() {
  std::vector<Vec3> found;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        const Vec3 v{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        if (max_abs(v) == 2) found.push_back(v * (1 / norm(v)));
      }
    }
  }
  return found;
}

// Whether x + y, rounded to `sum`, was a float64.
bool is_sum(double sum, double x, double y) {
  const double part = sum - x;
  return (x - (sum - part)) + (y - part) == 0;
}

class Search {
 public:
  Search(const Surface& a, const Surface& b, const DepthGoal& goal) : a_(a), b_(b), moved_(a), goal_(goal) {
    result_.upper = goal.upper;
  }

  DepthInterval run() {
    ask_meshes({0, 0, 0});
    push({0, 0, 0}, in_plane(Vec3{1, 1, 1} * root_half(result_.upper)), {}, 0);
    double open_from = result_.upper;
    while (!open_.empty()) {
      TranslationBox box = open_.top();
      open_.pop();
      open_from = box.key;
      if (std::fmax(std::fmin(open_from, covered_to_), goal_.lower) >= enough()) break;
      if (work() >= goal_.work) {
        result_.stop = DepthStop::work_spent;
        break;
      }
      if (!scanned_ && work() >= goal_.work / kScanAfter) {
        scan_spheres(std::fmax(box.key, result_.upper / kSmallestSphere));
        push(box.centre, box.half, std::move(box.sets), box.seen);
        continue;
      }
      ++result_.boxes;
      poll();
      open_from = result_.upper;
      if (is_covered(box) || is_covered_by_several(box)) continue;
      Vec3 t = box.nearest_to_origin();
      if (is_on_seam(box)) {
        fit(on_facets(box));
      } else if (find_open(box, t) || is_open(box, t = box.centre)) {
        ask_meshes(t);
      }
      if (is_covered(box)) continue;
      split(box);
    }
    snap();
    result_.bound = result_.upper + (result_.found ? rounding(result_.way_out) : 0);
    result_.lower = std::fmax(goal_.lower, std::fmin(covered_to_, open_from) * (1 - kNormError));
    result_.lower = std::fmin(result_.lower, result_.upper);
    result_.work = work();
    result_.sets = static_cast<std::uint32_t>(sets_.size());
    return result_;
  }

 private:
  // Where translations lie in a plane, the boxes are flat, and so is whatever points at them.
  Vec3 in_plane(Vec3 t) const {
    switch (goal_.across) {
      case 0: return {0, t.y, t.z};
      case 1: return {t.x, 0, t.z};
      case 2: return {t.x, t.y, 0};
      default: return t;
    }
  }

  std::uint64_t work() const { return work_done - start_; }

  // Translations that are longer need not be forbidden.
  double enough() const { return (1 - goal_.width) * result_.upper; }

  void push(Vec3 centre, Vec3 half, std::vector<std::uint32_t> sets, std::uint32_t seen) {
    TranslationBox box{0, centre, half, std::move(sets), seen, next_number_++};
    box.key = norm(box.nearest_to_origin());
    if (box.key >= result_.upper) return;
    work_done += kBoxWork;
    open_.push(std::move(box));
  }

  void split(const TranslationBox& box) {
    const Vec3 h = box.half;
    const int axis = h.x >= h.y && h.x >= h.z ? 0 : h.y >= h.z ? 1 : 2;
    Vec3 half = h, shift;
    (axis == 0 ? half.x : axis == 1 ? half.y : half.z) *= 0.5;
    (axis == 0 ? shift.x : axis == 1 ? shift.y : shift.z) = half[axis];
    push(box.centre - shift, half, box.sets, box.seen);
    push(box.centre + shift, half, box.sets, box.seen);
  }

  // Whether one set forbids all translations in the box that are short enough to matter.
  bool is_covered(TranslationBox& box) {
    const Aabb bounds = box.bounds();
    for (; box.seen < sets_.size(); ++box.seen) {
      if (meet(sets_[box.seen].box, bounds)) box.sets.push_back(box.seen);
    }
    double farthest = -INFINITY;
    std::size_t kept = 0;
    for (const std::uint32_t i : box.sets) {
      work_done += kPlaneWork * sets_[i].normal.size();
      const ForbiddenSet::Reach reach = sets_[i].reach(box.centre, box.half);
      if (reach.meets) box.sets[kept++] = i;
      farthest = std::fmax(farthest, reach.length);
      if (farthest >= result_.upper) break;
    }
    if (farthest >= enough()) {
      covered_to_ = std::fmin(covered_to_, farthest);
      return true;
    }
    box.sets.resize(kept);
    return false;
  }

  // The same by one set and, for each part of the box beyond a facet of that, one more. So two sets that overlap but
  // little cover the seam between them in few boxes.
  bool is_covered_by_several(const TranslationBox& box) {
    if (box.sets.size() < 2) return false;
    for (const std::uint32_t i : box.sets) {
      const double length = length_covered_with(i, box);
      if (length < enough()) continue;
      covered_to_ = std::fmin(covered_to_, length);
      return true;
    }
    return false;
  }

  double length_covered_with(std::uint32_t first, const TranslationBox& box) {
    const ForbiddenSet& set = sets_[first];
    work_done += kPlaneWork * set.normal.size();
    cuts_.clear();
    double length = INFINITY;
    for (std::size_t k = 0; k < set.normal.size(); ++k) {
      const Vec3 n = set.normal[k];
      const double middle = dot(n, box.centre), at = set.offset[k];
      const double spread = std::fabs(n.x) * box.half.x + std::fabs(n.y) * box.half.y + std::fabs(n.z) * box.half.z;
      if (middle + spread < at) continue;
      if (at >= enough()) {
        length = std::fmin(length, at);
      } else if (middle >= at || cuts_.size() == kMostCuts) {
        return -INFINITY;
      } else {
        cuts_.push_back({n, at});
      }
    }
    for (const Wall& cut : cuts_) {
      double beyond = -INFINITY;
      for (std::size_t j = 0; j < box.sets.size() && beyond < enough(); ++j) {
        if (box.sets[j] == first) continue;
        beyond = std::fmax(beyond, sets_[box.sets[j]].reach_beyond(box.centre, box.half, cut.normal, cut.offset, enough()));
      }
      length = std::fmin(length, beyond);
      if (length < enough()) return -INFINITY;
    }
    return length;
  }

  // Whether no set holds t, and it is short enough to matter.
  bool is_open(const TranslationBox& box, Vec3 t) {
    return norm(t) < enough() && std::none_of(box.sets.begin(), box.sets.end(), [&](std::uint32_t i) {
      work_done += kPlaneWork * sets_[i].normal.size();
      return sets_[i].exit(t).depth > 0;
    });
  }

  // The point nearest to t that no set holds, if it is in the box and short enough to matter.
  bool find_open(const TranslationBox& box, Vec3& t) {
    const Vec3 start = t;
    const double beyond = kIntoTheOpen * max_abs(box.half);
    std::vector<Wall> walls;
    while (norm(t) < enough()) {
      ForbiddenSet::Exit deepest;
      for (const std::uint32_t i : box.sets) {
        work_done += kPlaneWork * sets_[i].normal.size();
        const ForbiddenSet::Exit exit = sets_[i].exit(t);
        if (exit.depth > deepest.depth) deepest = exit;
      }
      if (!(deepest.depth > 0)) return box.contains(t);
      if (walls.size() >= kSetsLeft) return false;
      walls.push_back({deepest.normal, dot(deepest.normal, t - start) + deepest.depth + beyond});
      const std::optional<Vec3> next = nearest_beyond(walls);
      if (!next) return false;
      t = in_plane(start + *next);
    }
    return false;
  }

  void poll() {
    if (!goal_.poll || work() < next_poll_) return;
    next_poll_ = work() + kPollWork;
    goal_.poll();
  }

  bool is_on_seam(const TranslationBox& box) const { return max_abs(box.half) < kSeam * result_.upper; }

  MeshRelation relation_at(Vec3 t) {
    poll();
    ++result_.mesh_tests;
    work_done += kVertexWork * a_.mesh.vertices.size();
    return overlap_relation(moved_.at(t), b_);
  }

  static bool is_free(const MeshRelation& r) {
    return r.proven && (r.relation == Relation::separated || r.relation == Relation::touching);
  }

  void take(Vec3 way_out) {
    if (norm(way_out) >= result_.upper) return;
    result_.upper = norm(way_out);
    result_.way_out = way_out;
    result_.found = true;
  }

  // Settles t, a way out or one more set that holds it; then, as long as that leads to a shorter way out than
  // is known, the nearest point to the origin beyond the walls of the sets that were met.
  void ask_meshes(Vec3 t) {
    std::vector<Wall> walls;
    for (int asked = 0; asked < kStepsOut && walls.size() < kMostWalls && work() < goal_.work;) {
      ForbiddenSet::Exit exit = deepest_exit(t);
      if (!(exit.depth > 0)) {
        ++asked;
        const MeshRelation relation = relation_at(t);
        if (is_free(relation)) return take(t);
        ForbiddenSet set = proof_at(t, relation);
        if (set.empty()) return;
        exit = set.exit(t);
        sets_.push_back(std::move(set));
      }
      walls.push_back({exit.normal, dot(exit.normal, t) + exit.depth + kBeyond * result_.upper});
      const std::optional<Vec3> next = nearest_beyond(walls);
      if (!next || norm(*next) >= result_.upper) return;
      t = in_plane(*next);
    }
  }

  ForbiddenSet proof_at(Vec3 t, const MeshRelation& relation) {
    const Overlaps overlaps = sets_.size() < kManySets ? Overlaps::first : Overlaps::thickest;
    return prove_overlap(a_, moved_.at(t), b_, t, relation, overlaps);
  }

  ForbiddenSet::Exit deepest_exit(Vec3 t) {
    ForbiddenSet::Exit deepest;
    const Aabb point{t, t};
    for (const ForbiddenSet& set : sets_) {
      if (!meet(set.box, point)) continue;
      work_done += kPlaneWork * set.normal.size();
      const ForbiddenSet::Exit exit = set.exit(t);
      if (exit.depth > deepest.depth) deepest = exit;
    }
    return deepest;
  }

  // A way out on the smallest of some spheres, for what is longer than it need not be searched.
  void scan_spheres(double radius) {
    scanned_ = true;
    for (; radius < result_.upper; radius *= kSphereRatio) {
      for (const Vec3 way : ways()) {
        if (!(in_plane(way) == way)) continue;
        if (work() >= goal_.work) return;
        const Vec3 t = way * radius;
        const auto holds = [&](const ForbiddenSet& set) { return set.exit(t).depth > 0; };
        if (std::any_of(sets_.begin(), sets_.end(), holds)) continue;
        if (is_free(relation_at(t))) take(t);
      }
    }
    if (result_.found) ask_meshes(result_.way_out * (1 - kScanStep));
  }

  // The box's nearest point, shifted onto the facets that cut the box.
  Vec3 on_facets(const TranslationBox& box) const {
    Vec3 t = box.nearest_to_origin();
    for (const std::uint32_t i : box.sets) {
      for (std::size_t k = 0; k < sets_[i].normal.size(); ++k) {
        const Vec3 n = sets_[i].normal[k];
        const double spread = std::fabs(n.x) * box.half.x + std::fabs(n.y) * box.half.y + std::fabs(n.z) * box.half.z;
        if (std::fabs(sets_[i].facet[k] - dot(n, box.centre)) <= spread) t = t + n * (sets_[i].facet[k] - dot(n, t));
      }
    }
    return in_plane(t);
  }

  // Where forbidden sets only touch, A fits between the parts of B without play: t is shifted by less than
  // the rounding of the sets until corners lie in faces, to see whether the meshes are free there.
  void fit(Vec3 t) {
    for (int step = 0; step < kStepsOut; ++step) {
      const MeshRelation relation = relation_at(t);
      if (is_free(relation)) return take(t);
      CornerPlane nearest{INFINITY, -1, {}};
      for (const CornerPlane& plane : met_planes(relation)) {
        if (plane.distance(t) > 0 && plane.distance(t) < nearest.distance(t)) nearest = plane;
      }
      if (!(nearest.distance(t) <= kSeam * result_.upper)) break;
      t = in_plane(nearest.nearest_to(t));
    }
    if (!deepen(t)) ask_meshes(t);
  }

  // One more set that holds t, farther inside than those that are known.
  bool deepen(Vec3 t) {
    const double known = std::fmax(deepest_exit(t).depth, 0.0);
    ForbiddenSet set = proof_at(t, relation_at(t));
    if (!(set.exit(t).depth > kDeeper * known)) return false;
    sets_.push_back(std::move(set));
    return true;
  }

  // A way out along the normal of a face ends exactly where a corner leaves the plane of that face.
  void snap() {
    if (!result_.found) return;
    const double length = norm(result_.way_out);
    for (const CornerPlane& plane : met_planes(relation_at(result_.way_out * (1 - kSnap)))) {
      const Vec3 t = in_plane(plane.normal * plane.height);
      const bool agrees = norm(t - result_.way_out) <= kSnap * length;
      if (agrees && norm(t) < result_.upper && is_free(relation_at(t))) take(t);
    }
  }

  // How much longer than t a translation may have to be: 0 where it is along an axis and adding it rounds nothing.
  double rounding(Vec3 t) const {
    const int axes = (t.x != 0) + (t.y != 0) + (t.z != 0);
    double farthest = 0;
    bool exact = true;
    for (const Vec3 p : a_.mesh.vertices) {
      const Vec3 moved = p + t;
      exact = exact && is_sum(moved.x, p.x, t.x) && is_sum(moved.y, p.y, t.y) && is_sum(moved.z, p.z, t.z);
      farthest = std::fmax(farthest, max_abs(moved));
    }
    return (axes > 1 ? kNormError * norm(t) : 0) + (exact ? 0 : 2 * kUnitRoundoff * farthest);
  }

  // Of the triangles at which the relation was decided.
  std::vector<CornerPlane> met_planes(const MeshRelation& relation) const {
    if (relation.triangle_a == kNoTriangle || relation.triangle_b == kNoTriangle) return {};
    return corner_planes(corners(a_.mesh, relation.triangle_a), corners(b_.mesh, relation.triangle_b));
  }

  const Surface& a_;
  const Surface& b_;
  MovedSurface moved_;
  DepthGoal goal_;
  std::uint64_t start_ = work_done;
  DepthInterval result_;
  double covered_to_ = INFINITY;  // the boxes that were dropped hold no shorter way out
  std::vector<ForbiddenSet> sets_;
  std::vector<Wall> cuts_;  // of length_covered_with()
  std::priority_queue<TranslationBox, std::vector<TranslationBox>, Later> open_;
  std::uint64_t next_number_ = 0, next_poll_ = kPollWork;
  bool scanned_ = false;
};

// An order that does not depend on which mesh is called A: the smaller mesh is moved.
bool comes_first(const Mesh& a, const Mesh& b) {
  if (a.triangles.size() != b.triangles.size()) return a.triangles.size() < b.triangles.size();
  if (a.vertices.size() != b.vertices.size()) return a.vertices.size() < b.vertices.size();
  const auto less = [](Vec3 p, Vec3 q) { return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z; };
  const auto precedes = [&](const Mesh& p, const Mesh& q) {
    return std::lexicographical_compare(p.vertices.begin(), p.vertices.end(), q.vertices.begin(), q.vertices.end(), less);
  };
  if (precedes(a, b) || precedes(b, a)) return precedes(a, b);
  return a.triangles <= b.triangles;
}

DepthInterval search_near_origin(const Surface& a, const Surface& b, const DepthGoal& goal) {
  if (comes_first(a.mesh, b.mesh)) return Search(a, b, goal).run();
  DepthInterval result = Search(b, a, goal).run();
  result.way_out = Vec3{} - result.way_out;
  return result;
}

}  // namespace

DepthInterval search_depth(const Surface& a, const Surface& b, const DepthGoal& goal) {
  const Vec3 centre = exact_centre(a, b);
  if (centre == Vec3{}) return search_near_origin(a, b, goal);
  MovedSurface moved_a(a), moved_b(b);
  return search_near_origin(moved_a.at(-centre), moved_b.at(-centre), goal);
}

}  // namespace satcheck
