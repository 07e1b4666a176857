// Method: branch and bound over boxes in the space of translations, least norm first. A forbidden set is a convex set
// of translations that are proven to leave an overlap (overlap_proof.hpp). Translations longer than the upper bound do
// not matter. A box is dropped when one set contains all of its translations that matter. The search tests the meshes
// near the box's nearest point if no set contains that place. If they are free, this is an upper bound. If they
// overlap, this proves a new set.
#include "depth/depth_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/rounding.hpp"
#include "depth/forbidden_union.hpp"
#include "depth/overlap_proof.hpp"
#include "depth/planes.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "mesh_pair/moved_surface.hpp"

namespace satcheck {
namespace {

// Measured steps of a box and of moving a vertex.
constexpr std::uint64_t kBoxWork = 300, kVertexWork = 10;

// Steps out of one set after another until the meshes are free.
constexpr int kStepsOut = 8;
constexpr std::size_t kMostWalls = 24;
// A step goes this far beyond the boundary of a set, so that rounding does not leave it inside. A share of the known
// way out.
constexpr double kBeyond = 1e-10;
// From this many sets on, each is made where the bodies overlap the most.
constexpr std::size_t kManySets = 40;
// A new set on a seam is kept if the point is this many times deeper in it than in the others.
constexpr double kDeeper = 2;
// A way out that ends near a face is changed to end on the face if the lengths agree to this share.
constexpr double kSnap = 1e-6;
// Boxes smaller than this share of the known way out count as lying on a seam of two sets if no set contains them.
constexpr double kSeam = 1e-5;

// After so much work, spheres from 1 / kSmallestSphere of the known way out on are scanned for a shorter one, by this share
// of the work that follows. No step depends on the work that may be spent, so more of it only adds steps: it never gives a
// longer way out, nor a wider interval.
constexpr std::uint64_t kScanAfter = 16'000'000, kScanShare = 2;
constexpr double kSmallestSphere = 64, kSphereRatio = 1.2, kScanStep = 0.05;

// A way out is shortened by steps of kScanStep of its length at first, and of this at last, each by at least so much. That
// takes at most so many steps of work, and this share of those before.
constexpr double kLeastPolish = 2e-4, kLeastGain = 1e-4;
constexpr std::uint64_t kPolishWork = 2'000'000, kPolishShare = 8;

// Rounding of the norm of a point.
constexpr double kNormError = 4 * kUnitRoundoff;

// Unit vectors in all directions, towards the points of a lattice on the surface of a cube.
const std::vector<Vec3>& ways() {
  static const std::vector<Vec3> made = [] {
    std::vector<Vec3> directions;
    for (int k = 0; k < 125; ++k) {
      const Vec3 v{k / 25 - 2.0, k / 5 % 5 - 2.0, k % 5 - 2.0};
      if (max_abs(v) == 2) directions.push_back(v * (1 / norm(v)));
    }
    return directions;
  }();
  return made;
}

// Whether x + y was exact. sum: x + y, rounded.
bool is_sum(double sum, double x, double y) {
  const double part = sum - x;
  return (x - (sum - part)) + (y - part) == 0;
}

class Search {
 public:
  Search(const Surface& a, const Surface& b, const DepthGoal& goal)
      : a_(a), b_(b), moved_(a), goal_(goal), budget_(goal.work, goal.poll), sets_(goal.across, budget_) {
    result_.upper = goal.upper;
    if (goal.prove) sphere_ = INFINITY;
  }
  Search(const Search&) = delete;  // the sets refer to the budget
  Search& operator=(const Search&) = delete;

  DepthInterval run() {
    ask_meshes({0, 0, 0});
    push({{0, 0, 0}, in_plane(Vec3{1, 1, 1} * root_half(result_.upper)), {}, 0, record_.add_root()});
    double open_from = result_.upper;
    while (!open_.empty()) {
      while (is_scan_due()) scan();
      reached_ = open_from = -open_.key();
      TranslationBox box = open_.pop();
      if (proven() >= enough()) break;
      if (proven() >= goal_.limit) {
        result_.stop = SearchStop::decided;
        break;
      }
      if (budget_.is_spent()) {
        result_.stop = SearchStop::work_spent;
        break;
      }
      ++result_.boxes;
      poll();
      open_from = result_.upper;
      if (is_covered(box) || (!goal_.prove && is_dropped(sets_.covered_by_several(box, enough())))) continue;
      if (is_on_seam(box)) {
        fit(sets_.on_facets(box));
      } else if (const auto t = sets_.nearest_open(box, box.nearest_to_origin(), enough())) {
        ask_meshes(*t);
      } else if (sets_.is_open(box, box.centre, enough())) {
        ask_meshes(box.centre);
      }
      if (is_covered(box)) continue;
      split(box);
    }
    result_.lower = std::fmax(goal_.lower, std::fmin(covered_to_, open_from) * (1 - kNormError));
    if (!goal_.prove) {
      if (result_.stop == SearchStop::narrow) polish();
      snap();
    }
    result_.bound = result_.upper + (result_.has_way_out ? rounding(result_.way_out) : 0);
    result_.lower = std::fmin(result_.lower, result_.upper);
    result_.work = budget_.spent();
    result_.sets = static_cast<std::uint32_t>(sets_.size());
    return result_;
  }

  // turned: what moves is B. After a search that proves all of it.
  std::optional<DepthProof> proof(bool turned) const {
    if (!goal_.prove || result_.lower < goal_.upper * (1 - 2 * kNormError)) return std::nullopt;
    return record_.proof(root_half(goal_.upper), regions_, turned);
  }

 private:
  // If translations lie in a plane, boxes and directions are flat.
  Vec3 in_plane(Vec3 t) const { return satcheck::in_plane(t, goal_.across); }

  // Longer translations need not be forbidden.
  double enough() const { return (1 - goal_.width) * result_.upper; }

  void push(TranslationBox box) {
    const double nearest = norm(box.nearest_to_origin());
    if (nearest >= result_.upper) return record_.set_far(box.part);
    budget_.spend(kBoxWork);
    open_.push(-nearest, std::move(box));
  }

  void split(const TranslationBox& box) {
    const Vec3 h = box.half;
    const int axis = h.x >= h.y && h.x >= h.z ? 0 : h.y >= h.z ? 1 : 2;
    Vec3 half = h, shift;
    half.at(axis) *= 0.5;
    shift.at(axis) = half[axis];
    const std::uint32_t first = record_.halve(box.part);
    push({box.centre - shift, half, box.sets, box.seen, first});
    push({box.centre + shift, half, box.sets, box.seen, first + 1});
  }

  // Whether one set forbids all translations in the box that are short enough to matter.
  bool is_covered(TranslationBox& box) {
    if (!is_dropped(sets_.covered_by_one(box, enough(), result_.upper))) return false;
    record_.set_held(box.part, box.held_by);
    return true;
  }

  // Whether a box can be dropped. covered: all translations in it up to this length are forbidden.
  bool is_dropped(double covered) {
    if (covered < enough()) return false;
    covered_to_ = std::fmin(covered_to_, covered);
    return true;
  }

  // All shorter translations leave an overlap.
  double proven() const { return std::fmax(std::fmin(reached_, covered_to_), goal_.lower); }

  void poll() {
    if (budget_.is_due()) budget_.tell(proven(), result_.upper);
  }

  bool is_on_seam(const TranslationBox& box) const { return max_abs(box.half) < kSeam * result_.upper; }

  MeshRelation relation_at(Vec3 t) {
    poll();
    budget_.note(proven(), result_.upper);
    ++result_.mesh_tests;
    budget_.spend(kVertexWork * a_.mesh.vertices.size());
    return overlap_relation(moved_.at(t, &budget_), b_, &budget_);
  }

  void take(Vec3 way_out) {
    if (norm(way_out) >= result_.upper) return;
    result_.upper = norm(way_out);
    result_.way_out = way_out;
    result_.has_way_out = true;
  }

  // Tests the meshes at t, which gives a way out or a new set that contains t. Then tests the nearest point to the
  // origin beyond the walls of the sets so far, as long as it may give a way out that is shorter by this share.
  void ask_meshes(Vec3 t, double gain = 0) {
    std::vector<Wall> walls;
    for (int asked = 0; asked < kStepsOut && walls.size() < kMostWalls && !budget_.is_spent();) {
      ForbiddenSet::Exit exit = sets_.deepest_exit(t);
      if (!(exit.depth > 0)) {
        ++asked;
        const MeshRelation relation = relation_at(t);
        if (relation.is_free()) return take(t);
        OverlapProof proof = proof_at(t, relation);
        if (proof.set.empty()) return;
        exit = proof.set.exit(t);
        add(std::move(proof));
      }
      walls.push_back({exit.normal, dot(exit.normal, t) + exit.depth + kBeyond * result_.upper});
      const std::optional<Vec3> next = nearest_beyond(walls);
      if (!next || norm(*next) >= result_.upper * (1 - gain)) return;
      t = in_plane(*next);
    }
  }

  void add(OverlapProof proof) {
    sets_.add(std::move(proof.set));
    if (goal_.prove) regions_.push_back(std::move(proof.regions));
  }

  OverlapProof proof_at(Vec3 t, const MeshRelation& relation) {
    const Overlaps overlaps = sets_.size() < kManySets ? Overlaps::first : Overlaps::thickest;
    return prove_overlap(a_, moved_.at(t, &budget_), b_, t, relation, overlaps, goal_.prove, budget_);
  }

  bool is_scan_due() const {
    const std::uint64_t spent = budget_.spent();
    return sphere_ < result_.upper && spent >= kScanAfter && scan_work_ * kScanShare <= spent - kScanAfter && !budget_.is_spent();
  }

  // Tests the next place on spheres, the smallest first. Longer translations need not be searched once one is free.
  void scan() {
    const std::uint64_t before = budget_.spent();
    if (sphere_ == 0) sphere_ = std::fmax(-open_.key(), result_.upper / kSmallestSphere);
    const Vec3 way = ways()[scanned_ways_];
    const Vec3 t = way * sphere_;
    if (in_plane(way) == way && !sets_.holds(t) && relation_at(t).is_free()) take(t);
    if (++scanned_ways_ == ways().size()) {
      scanned_ways_ = 0;
      sphere_ *= kSphereRatio;
    }
    if (sphere_ >= result_.upper && result_.has_way_out) ask_meshes(result_.way_out * (1 - kScanStep));
    scan_work_ += budget_.spent() - before;
  }

  // If forbidden sets only touch, A may fit between the parts of B without clearance. t is shifted by less than the
  // rounding of the sets until corners lie in faces, and the meshes are tested there.
  void fit(Vec3 t) {
    for (int step = 0; step < kStepsOut; ++step) {
      const MeshRelation relation = relation_at(t);
      if (relation.is_free()) return take(t);
      CornerPlane nearest{INFINITY, -1, {}};
      for (const CornerPlane& plane : met_planes(relation)) {
        if (plane.distance(t) > 0 && plane.distance(t) < nearest.distance(t)) nearest = plane;
      }
      if (!(nearest.distance(t) <= kSeam * result_.upper)) break;
      t = in_plane(nearest.nearest_to(t));
    }
    if (!deepen(t)) ask_meshes(t);
  }

  // Adds a set in which t is deeper than in all others.
  bool deepen(Vec3 t) {
    const double known = std::fmax(sets_.deepest_exit(t).depth, 0.0);
    OverlapProof proof = proof_at(t, relation_at(t));
    if (!(proof.set.exit(t).depth > kDeeper * known)) return false;
    add(std::move(proof));
    return true;
  }

  // Shortens the way out by steps in all directions: the interval may be narrow before it is the shortest one near it.
  void polish() {
    const std::uint64_t end = budget_.spent() + budget_.spent() / kPolishShare + kPolishWork;
    for (double step = kScanStep; result_.has_way_out && step > kLeastPolish; step *= 0.5) {
      if (result_.lower >= result_.upper * (1 - kLeastPolish)) return;
      ask_meshes(result_.way_out * (1 - step), kLeastGain);
      for (const Vec3 way : ways()) {
        const Vec3 t = in_plane(result_.way_out + way * (step * result_.upper));
        if (budget_.is_spent() || budget_.spent() > end) return;
        if (norm(t) <= result_.lower || norm(t) >= result_.upper * (1 - kLeastGain)) continue;
        if (!sets_.holds(t) && relation_at(t).is_free()) take(t);
      }
    }
  }

  // Corrects a way out along the normal of a face to end exactly where a corner leaves the plane of that face.
  void snap() {
    if (!result_.has_way_out) return;
    const double length = norm(result_.way_out);
    for (const CornerPlane& plane : met_planes(relation_at(result_.way_out * (1 - kSnap)))) {
      const Vec3 t = in_plane(plane.normal * plane.height);
      const bool agrees = norm(t - result_.way_out) <= kSnap * length;
      if (agrees && norm(t) < result_.upper && relation_at(t).is_free()) take(t);
    }
  }

  // An upper bound of the length that rounding adds to t. 0 if t is along an axis and rounds no coordinate.
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

  // The corner planes of the triangles that decided the relation.
  std::vector<CornerPlane> met_planes(const MeshRelation& relation) const {
    if (relation.triangle_a == kNoIndex || relation.triangle_b == kNoIndex) return {};
    return corner_planes(corners(a_.mesh, relation.triangle_a), corners(b_.mesh, relation.triangle_b));
  }

  const Surface& a_;
  const Surface& b_;
  MovedSurface moved_;
  DepthGoal goal_;
  Budget budget_;
  DepthInterval result_;
  double covered_to_ = INFINITY;  // the dropped boxes contain no shorter way out
  double reached_ = 0;            // and the open ones none shorter than this
  ForbiddenUnion sets_;
  DepthRecord record_;
  std::vector<RegionPair> regions_;  // of each set, where the search writes down its proof
  BestFirst<TranslationBox> open_;  // those nearest to the origin first
  double sphere_ = 0;  // radius of the one that is scanned; 0: none yet; from `upper` on: all are
  std::size_t scanned_ways_ = 0;
  std::uint64_t scan_work_ = 0;
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

}  // namespace

DepthInterval search_depth(const Surface& a, const Surface& b, const DepthGoal& goal) {
  const NearOrigin pair(a, b);
  const bool turned = !comes_first(pair.a.mesh, pair.b.mesh);
  Search search(turned ? pair.b : pair.a, turned ? pair.a : pair.b, goal);
  DepthInterval result = search.run();
  result.proof = search.proof(turned);
  if (result.proof) result.proof->origin = pair.centre;
  if (turned) result.way_out = Vec3{} - result.way_out;
  return result;
}

}  // namespace satcheck
