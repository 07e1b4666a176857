#include "ladder/climb.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>

#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "convex/exact_depth.hpp"
#include "convex/hulls_apart.hpp"
#include "mesh_pair/open_surfaces.hpp"
#include "ladder/touch_proof.hpp"
#include "ladder/broad_phase.hpp"

namespace satcheck {
namespace {

// The most pairs that one thread takes at a time: neighbours along the curve share bodies. If there are few pairs, they
// may be large, and each thread takes fewer at a time.
constexpr std::size_t kTogether = 8;
constexpr std::size_t kTurns = 4;

// Most pairs are quick.
constexpr std::size_t kBetweenPolls = 64;

// Vertices of a body that are worth a thread of their own.
constexpr std::size_t kManyVertices = 8192;

// Vertices of a body of which a few rounds over all take less time than their hull.
constexpr std::size_t kManyForHull = 256;

// A body is cut to a region for one pair only if the region is at most this share of its box, because cutting has a
// cost.
constexpr double kLittle = 0.5;

std::optional<ContactPair> crossing_of(const MeshRelation& r) {
  if (r.triangle_a == kNoIndex || r.triangle_b == kNoIndex) return {};
  return ContactPair{r.triangle_a, r.triangle_b};
}

// The share of the volume of a box within another box; 1 if the box has no volume.
double share_within(const Aabb& box, const Aabb& other) {
  double share = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double common = std::fmin(box.max[axis], other.max[axis]) - std::fmax(box.min[axis], other.min[axis]);
    const double size = box.max[axis] - box.min[axis];
    share *= size > 0 ? std::fmax(common, 0) / size : 1;
  }
  return share;
}

bool is_large(PlacedGeometry& body, std::size_t many = kManyVertices) { return body.shared().mesh()->vertices.size() >= many; }

// Calls make(body) for both bodies; for large ones in parallel.
template <class Make>
void make_both(PlacedGeometry& a, PlacedGeometry& b, Make make) {
  const unsigned threads = is_large(a) && is_large(b) ? 0 : 1;
  parallel_for(2, threads, [&](std::size_t i) { make(i == 0 ? a : b); });
}

// In this thread, which hears signals. budget: is polled, and pays nothing.
void make_hull_shapes(PlacedGeometry& a, PlacedGeometry& b, const Budget& budget) {
  Budget polling = Budget::that_stops(kNoEnd, [&](const SearchState& state) { budget.tell_again(state.work); });
  for (PlacedGeometry* body : {&a, &b}) body->hull_shape(&polling);
}

// Whether the hulls serve one pair only, and cost more than scans of the vertices.
bool spares_hulls(PlacedGeometry& a, PlacedGeometry& b, bool alone) {
  return alone && (is_large(a, kManyForHull) || is_large(b, kManyForHull));
}

double largest_coordinate(PlacedGeometry& a, PlacedGeometry& b) {
  return larger(a.bounds().largest_coordinate(), b.bounds().largest_coordinate());
}

std::optional<PairResult> check_hulls_of_points(PlacedGeometry& a, PlacedGeometry& b, Query query, const Budget& budget) {
  return check_hulls_of(a.mesh()->vertices, b.mesh()->vertices, largest_coordinate(a, b), query, &budget);
}

class Climber {
 public:
  Climber(const ClimbRequest& request, Rung first, Rung last, const Poll& poll)
      : request_(request),
        first_(first),
        last_(last),
        budget_(budget_of_pair(*request.a->shared().mesh(), *request.b->shared().mesh(), poll, request.steps)) {}

  Climb take() {
    try {
      climb_rungs();
    } catch (const BudgetSpent&) {  // the relation is decided, and the gap or the band is not
      climb_.gap.reset();
      climb_.way_within.emplace();
    }
    climb_.steps = budget_.spent();
    climb_.too_few_steps = budget_.is_spent();
    climb_.verdict = verdict_of(request_, climb_);
    return climb_;
  }

 private:
  void climb_rungs() {
    const bool apart = timed(kBoxes, [&] {
      climb_.box_gap = box_gap(request_.a->bounds(), request_.b->bounds());
      return climb_.box_gap > request_.gap_limit;
    });
    if (takes(Rung::aabb) && apart) return;
    if (takes(Rung::obb) && timed(kOriented, [&] { return oriented_boxes_settle(); })) return;
    if (takes(Rung::hull) && hulls_settle()) {
      if (hulls_leave_gap_open()) timed(kBand, [&] { return measure_gap(); });
      return;
    }
    if (takes(Rung::triangles)) triangles();
  }

  bool takes(Rung rung) const { return first_ <= rung && rung <= last_; }

  template <class Step>
  bool timed(Clock clock, Step step) {
    const auto start = std::chrono::steady_clock::now();
    const bool result = step();
    climb_.nanoseconds[clock] =
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start).count();
    return result;
  }

  bool oriented_boxes_settle() {
    double pad_a = request_.a->resolution(), pad_b = request_.b->resolution();
    if (pad_a + pad_b < request_.gap_limit) pad_a = pad_b = 0.5 * request_.gap_limit;
    const OrientedBox a = request_.a->oriented_box(pad_a), b = request_.b->oriented_box(pad_b);
    if (!a.turned && !b.turned) {
      climb_.boxes = BoxOutcome::unturned;
    } else if (!a.is_box || !b.is_box) {
      climb_.boxes = BoxOutcome::sheared;
    } else {
      climb_.box_axis = separating_axis(a, b);
      climb_.boxes = climb_.box_axis.feature == Feature::none ? BoxOutcome::meet : BoxOutcome::apart;
    }
    return climb_.boxes == BoxOutcome::apart;
  }

  PairResult ask_hulls(Query query) {
    return check_pair(*request_.a->hull_shape(), {}, *request_.b->hull_shape(), {}, query, request_.method);
  }

  bool hulls_settle() {
    const bool settled = timed(kHulls, [&] {
      climb_.both_convex = request_.a->shared().convex() && request_.b->shared().convex();
      if (!climb_.both_convex && spares_hulls(*request_.a, *request_.b, request_.alone)) return points_are_apart();
      return climb_.both_convex ? convex_bodies_settle() : hulls_are_apart();
    });
    const bool overlap = climb_.both_convex && climb_.hulls->outcome == Outcome::penetrating;
    if (overlap && request_.depth() > 0 && -climb_.hulls->lower > request_.tolerance) {
      timed(kBand, [&] {
        climb_.thick = has_thick_point(*request_.a->mesh(), *request_.b->mesh(), *climb_.hulls, request_.depth());
        return true;
      });
    }
    if (overlap && boxes_nest()) {
      timed(kNesting, [&] {
        const MeshRelation nested = mesh_relation(*request_.a->surface(), *request_.b->surface(), budget_);
        climb_.decided = nested.decided;
        if (nested.decided) climb_.nesting = nested.relation;
        return true;
      });
    }
    return settled;
  }

  bool convex_bodies_settle() {
    climb_.hulls = hull_depth(*request_.a, *request_.b, request_.alone, budget_, request_.method);
    return climb_.hulls->outcome != Outcome::undecided;
  }

  double largest_coordinate() const { return satcheck::largest_coordinate(*request_.a, *request_.b); }

  bool points_are_apart() {
    climb_.hulls = check_hulls_of_points(*request_.a, *request_.b, Query::distance, budget_);
    return climb_.hulls ? climb_.hulls->outcome == Outcome::separated : hulls_are_apart();
  }

  bool hulls_are_apart() {
    make_hull_shapes(*request_.a, *request_.b, budget_);
    climb_.hulls = ask_hulls(Query::overlap);
    if (climb_.hulls->outcome != Outcome::separated) return false;
    climb_.hulls = ask_hulls(Query::distance);
    // The overlap is disproved for any value of the distance.
    climb_.hulls->outcome = Outcome::separated;
    return true;
  }

  // Whether the hulls may be closer than the gap limit.
  bool hulls_leave_gap_open() const {
    if (climb_.both_convex || last_ != Rung::triangles) return false;
    return !(gap_of_hulls(climb_) > request_.gap_limit);
  }

  bool boxes_nest() const {
    return request_.a->bounds().contains(request_.b->bounds()) || request_.b->bounds().contains(request_.a->bounds());
  }

  template <class Make>
  void make_surfaces(Make make) {
    make_both(*request_.a, *request_.b, [&](PlacedGeometry& body) { (&body == request_.a ? a_ : b_) = make(body); });
  }
  void make_whole_surfaces() {
    make_surfaces([](PlacedGeometry& body) { return body.surface(); });
  }

  // The region of surfaces that matter for the relation to this body, and for gaps up to the limit.
  Aabb reach_of(PlacedGeometry& body) const {
    return body.bounds().widened(2 * request_.gap_limit);
  }

  // Whether only a small part of each body can matter for the other, and no other stage needs the rest.
  bool little_matters() {
    const auto can_be_cut = [](PlacedGeometry& body) { return body.shared().plain() && body.placed_as_in_file(); };
    PlacedGeometry &a = *request_.a, &b = *request_.b;
    if (!request_.alone || !(is_large(a) || is_large(b)) || request_.wants_distance || !can_be_cut(a) || !can_be_cut(b)) return false;
    return share_within(a.bounds(), reach_of(b)) < kLittle && share_within(b.bounds(), reach_of(a)) < kLittle;
  }

  void triangles() {
    timed(kTriangles, [&] {
      if (little_matters()) {
        make_surfaces([&](PlacedGeometry& body) {
          return body.shared().surface_near(reach_of(&body == request_.a ? *request_.b : *request_.a));
        });
        climb_.triangles = simple_relation(*a_, *b_, budget_);
      }
      if (!climb_.triangles) {
        make_whole_surfaces();
        climb_.triangles = mesh_relation(*a_, *b_, budget_);
      }
      return true;
    });
    climb_.decided = climb_.triangles->decided;
    if (!climb_.decided || climb_.triangles->hole) return;
    const Relation relation = climb_.triangles->relation;
    if (relation == Relation::separated) {
      timed(kBand, [&] { return measure_gap(); });
    } else if (relation != Relation::touching && request_.depth() > 0) {
      timed(kBand, [&] { return explain_overlap(); });
    }
  }

  // Decides about the touch band if that needs no search.
  bool explain_overlap() {
    const MeshRelation& relation = *climb_.triangles;
    if (a_->solid && b_->solid) {
      climb_.thick = has_thick_point(*a_, *b_, relation, largest_coordinate(), request_.depth(), &budget_);
    }
    if (climb_.thick.value_or(false) || request_.tolerance == 0) return true;
    climb_.least_depth = least_depth(*a_, *b_, largest_coordinate(), relation, &budget_);
    if (*climb_.least_depth > request_.tolerance) return true;
    climb_.way_within = find_way_within(*request_.a, *request_.b, request_.tolerance, crossing_of(relation), budget_);
    return true;
  }

  // A gap that exceeds the touch band by more than rounding needs no figure.
  bool measure_gap() {
    if (request_.gap_limit == 0) return false;
    if (!a_) make_whole_surfaces();
    const double rounding = chain_rounding(largest_coordinate());
    climb_.gap = mesh_distance(*a_, *b_, request_.wants_distance ? INFINITY : request_.tolerance + rounding, {}, &budget_);
    if (!(a_->solid && b_->solid)) climb_.gap_of_holes = distance_of_holes(*a_, *b_, climb_.gap->distance, &budget_);
    return true;
  }

  const ClimbRequest& request_;
  Rung first_, last_;
  Budget budget_;
  std::shared_ptr<Surface> a_, b_;  // in the world, perhaps refined only near the other body
  Climb climb_;
};

Verdict apart(double gap, bool settled = true) { return {Relation::separated, settled, true, gap, {}}; }

bool has_common_interior(Relation relation) {
  return relation != Relation::separated && relation != Relation::touching;
}

Verdict by_triangles(const Climb& climb) {
  const MeshRelation& surfaces = *climb.triangles;
  Verdict verdict{surfaces.relation, true, surfaces.proven && !surfaces.hole, 0, {}};
  if (!surfaces.decided) return verdict;
  if (has_common_interior(surfaces.relation)) {
    verdict.band = climb.way_within ? climb.way_within->side : BandSide::deeper;
  }
  return verdict;
}

BandSide band_of_convex_bodies(const ClimbRequest& request, const PairResult& hulls) {
  const double tolerance = request.tolerance;
  if (tolerance == 0 || -hulls.upper > tolerance) return BandSide::deeper;
  if (-hulls.lower <= tolerance) return BandSide::within;
  const auto side = compare_signed_distance(*request.a->hull_shape(), {}, *request.b->hull_shape(), {}, -tolerance);
  if (!side) return BandSide::open;
  return *side >= 0 ? BandSide::within : BandSide::deeper;
}

// The surfaces differ from the hulls by the rounding of the pose. If nesting reports no common interior, the bodies can
// only graze each other, and the hulls have already decided that.
Verdict by_convex_hulls(const ClimbRequest& request, const Climb& climb, const PairResult& hulls) {
  const double gap = std::fmax(hulls.has_distance ? hulls.lower : 0.0, 0.0);
  if (hulls.outcome == Outcome::separated) return apart(gap);
  if (hulls.outcome == Outcome::touching) return {Relation::touching, true, true, gap, {}};
  const bool nested = climb.nesting && has_common_interior(*climb.nesting);
  return {nested ? *climb.nesting : Relation::penetrating, true, true, gap, band_of_convex_bodies(request, hulls)};
}

}  // namespace

PairResult hull_depth(PlacedGeometry& a, PlacedGeometry& b, bool alone, const Budget& budget, MethodChoice method) {
  if (method == MethodChoice::automatic && spares_hulls(a, b, alone)) {
    if (const auto depth = check_hulls_of_points(a, b, Query::depth, budget)) return *depth;
  }
  make_hull_shapes(a, b, budget);
  return check_pair(*a.hull_shape(), {}, *b.hull_shape(), {}, Query::depth, method);
}

Climb climb(const ClimbRequest& request, Rung first, Rung last, const Poll& poll) {
  return Climber(request, first, last, poll).take();
}

std::vector<std::optional<Climb>> climb_all(const std::vector<ClimbRequest>& requests, Rung last, unsigned threads,
                                            const Poll& poll) {
  std::vector<std::optional<Climb>> climbs(requests.size());
  const std::size_t workers = threads != 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  const std::size_t together = std::clamp<std::size_t>(requests.size() / (kTurns * workers), 1, kTogether);
  parallel_for(requests.size(), threads, [&](std::size_t i) {
    if (poll && i % kBetweenPolls == 0) poll({});
    try {
      climbs[i] = climb(requests[i], Rung::aabb, last, poll);
    } catch (const std::exception&) {  // climb() reports the error for this pair
      climbs[i].reset();
    }
  }, together);
  return climbs;
}

const PairResult* signed_distance(const Climb& climb) {
  return climb.both_convex && climb.hulls && climb.hulls->outcome != Outcome::undecided ? &*climb.hulls : nullptr;
}

const OpenHole* hole_in_the_way(const Climb& climb) {
  return climb.triangles && climb.triangles->hole ? &*climb.triangles->hole : nullptr;
}

double gap_of_hulls(const Climb& climb) {
  return std::fmax(climb.hulls->has_distance ? climb.hulls->lower : 0.0, climb.box_gap);
}

Verdict verdict_of(const ClimbRequest& request, const Climb& climb) {
  if (climb.triangles) return by_triangles(climb);
  if (const PairResult* convex = signed_distance(climb)) return by_convex_hulls(request, climb, *convex);
  if (climb.hulls && climb.hulls->outcome == Outcome::separated) return apart(gap_of_hulls(climb));
  if (climb.boxes == BoxOutcome::apart) return apart(std::nextafter(request.gap_limit, INFINITY));
  if (climb.box_gap > 0) return apart(climb.box_gap, climb.box_gap > request.gap_limit);
  return {};
}

}  // namespace satcheck
