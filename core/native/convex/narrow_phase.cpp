#include "convex/narrow_phase.hpp"

#include <algorithm>
#include <stdexcept>

#include "base/rounding.hpp"
#include "convex/box_pair.hpp"
#include "convex/contact_region.hpp"
#include "convex/curved_axis.hpp"
#include "convex/epa.hpp"
#include "convex/exact_depth.hpp"
#include "convex/exact_distance.hpp"
#include "convex/minkowski.hpp"
#include "convex/pair_order.hpp"
#include "convex/portal.hpp"
#include "convex/separating_face.hpp"
#include "convex/shape.hpp"

namespace satcheck {

namespace {

// Signed penetration of the cores of A and B, before margins: > 0 overlap, < 0 gap.
struct CoreAnswer {
  double lower = -INFINITY, upper = INFINITY;
  double value = INFINITY;  // between the bounds: minus the distance of the witness points, or the support value
  Vec3 axis;      // unit, A to B, frame of A
  Witnesses witness;
  bool has_axis = false;  // axis and witness are set
  Method method = Method::none;
  Feature feature = Feature::none;
  std::uint32_t index_a = kNoIndex, index_b = kNoIndex;
};

bool solid_polytopes(const MinkowskiDifference& m) {
  const auto is_solid = [](const Shape& s) { return s.is_polytope() && s.has_faces && s.polytope.dimension == 3; };
  return is_solid(m.a) && is_solid(m.b);
}

bool are_boxes(const MinkowskiDifference& m) { return m.a.is_box() && m.b.is_box(); }

bool takes_sat(const MinkowskiDifference& m, MethodChoice method) {
  return method != MethodChoice::gjk && (are_boxes(m) || (method == MethodChoice::sat && solid_polytopes(m)));
}

// `lower_bound` of the distance may come from another stage than GJK. The upper bound is the distance of two points of
// the shapes, because GJK measures its distance along a normal.
CoreAnswer from_gjk_distance(const MinkowskiDifference& m, const GjkResult& g, double lower_bound) {
  CoreAnswer answer;
  answer.witness = {g.simplex.witness_a(), g.simplex.witness_b()};
  const double reached = larger(lower_bound, norm(answer.witness.a - answer.witness.b));
  answer.lower = -larger(g.upper, reached);
  answer.upper = -lower_bound;
  answer.value = -std::clamp(g.upper, lower_bound, reached);
  answer.axis = g.upper > 0 ? g.v * (-1 / g.upper) : -g.axis;
  answer.has_axis = true;
  answer.method = Method::gjk;
  answer.feature = m.curved ? Feature::curved : Feature::vertices;
  return answer;
}

// The difference of the witness points from value * axis is distributed to both of them by halves.
void straighten(CoreAnswer& core) {
  const Vec3 middle = (core.witness.a + core.witness.b) * 0.5, half = core.axis * (core.value / 2);
  core.witness = {middle + half, middle - half};
}

// The gap is too small for GJK to prove, but EPA found a separating axis. GJK's closest points are valid. Its direction
// may be rounding noise, and counts only if it separates too.
CoreAnswer from_epa_gap(const MinkowskiDifference& m, const GjkResult& g, const EpaResult& e) {
  CoreAnswer answer = from_gjk_distance(m, g, -e.upper);
  if (dot(answer.axis, m.support(answer.axis).w) < 0) return answer;
  answer.axis = e.axis;
  straighten(answer);
  return answer;
}

// Runs GJK on the shapes, moved apart along the axis until they touch.
Witnesses touching_points(const MinkowskiDifference& m, Vec3 axis, double penetration) {
  MinkowskiDifference touching = m;
  touching.b_in_a.translation = touching.b_in_a.translation + axis * penetration;
  GjkResult g = gjk(touching);
  if (g.status == GjkResult::Status::encloses) weigh_enclosed_origin(g.simplex);
  return {g.simplex.witness_a(), g.simplex.witness_b() - axis * penetration};
}

// The last facet of EPA may be only a part of a flat face, and the projection of the origin may lie in another part.
// The witness points then come from the contact region, or, for curved shapes, from the points where they touch.
Witnesses overlap_witness(const MinkowskiDifference& m, const EpaResult& e) {
  const Witnesses facet{e.facet.witness_a(), e.facet.witness_b()};
  const double miss = norm(facet.a - facet.b - e.axis * e.upper);
  if (e.facet.count > 0 && miss <= (m.curved ? kCurvedFacetGap * m.scale : m.support_error())) return facet;
  if (m.a.is_polytope() && m.b.is_polytope()) return contact_region_centre(m, e.axis, e.upper);
  return touching_points(m, e.axis, e.upper);
}

// enough: no figures are needed of cores that overlap by more.
CoreAnswer from_epa(const MinkowskiDifference& m, const GjkResult& g, double enough, PairResult& result) {
  // Near contact, GJK's simplex on curved shapes is a sliver, and its faces prove nothing.
  static const Simplex none;
  const EpaResult e = epa(m, m.curved ? none : g.simplex, enough);
  result.epa_iterations += e.iterations;
  CoreAnswer answer;
  answer.method = Method::epa;
  answer.feature = m.curved ? Feature::curved : Feature::vertices;
  answer.axis = e.axis;
  answer.upper = answer.value = e.upper;
  switch (e.status) {
    case EpaResult::Status::depth:
    case EpaResult::Status::bounded:
      answer.lower = larger(e.lower, -g.upper);  // the distance is at most GJK's upper bound
      answer.has_axis = true;
      if (!(e.lower > enough)) answer.witness = overlap_witness(m, e);
      return answer;
    case EpaResult::Status::separated:
      return from_epa_gap(m, g, e);
    case EpaResult::Status::flat:
      answer.lower = answer.value = -g.upper;
      answer.has_axis = true;
      answer.witness = {g.simplex.witness_a(), g.simplex.witness_b()};
      return answer;
    case EpaResult::Status::stalled:
      break;
  }
  answer.lower = std::fmax(e.lower, -g.upper);
  answer.has_axis = std::isfinite(e.upper);
  answer.witness = overlap_witness(m, e);
  return answer;
}

CoreAnswer from_gjk(const MinkowskiDifference& m, double enough, PairResult& result) {
  const GjkResult g = gjk(m);
  result.gjk_iterations += g.iterations;
  if (g.status == GjkResult::Status::separated) return from_gjk_distance(m, g, g.lower);
  return from_epa(m, g, enough, result);
}

// Curved shapes have no exact stage here. Bounds that close around 0 count as touching.
Outcome classify(const CoreAnswer& core, const MinkowskiDifference& m, double noise) {
  const double margin = m.a.margin + m.b.margin;
  const double lower = core.lower + margin, upper = core.upper + margin;
  if (upper < -noise) return Outcome::separated;
  if (lower > noise) return Outcome::penetrating;
  const double band = m.curved || margin > 0 ? 2 * kCurvedFacetGap * m.scale : noise;
  return noise <= band && lower >= -band && upper <= band ? Outcome::touching : Outcome::undecided;
}

// Improves the last digits of a curved pair's axis, for a smaller upper bound. An overlap takes this axis, with its
// witness points: the support points, or other points of a flat face or a mantle line.
void polish(const MinkowskiDifference& m, CoreAnswer& core) {
  const AxisSupport best = least_support_near(m, core.axis);
  if (!(best.value < core.upper)) return;
  core.upper = best.value;
  core.value = std::fmin(core.value, best.value);
  if (core.method == Method::gjk) return;
  core.axis = best.axis;
  const bool unique = norm(best.point.w - best.axis * best.value) <= kCurvedFacetGap * m.scale;
  core.witness = unique ? Witnesses{best.point.a, best.point.a - best.point.w}
                        : touching_points(m, best.axis, best.value);
}

// The rounding error that a proof in float64 has to exceed. Cores with vertices are judged at their rounded world
// coordinates, curved cores at their exact pose.
double proof_noise(const MinkowskiDifference& m, const Pose& pose_a, const Pose& pose_b) {
  if (m.curved) return m.support_error() + origin_error(m.a, pose_a) + origin_error(m.b, pose_b);
  return satcheck::proof_noise(m.scale, placement_error(m.a, pose_a), placement_error(m.b, pose_b));
}

void write_stage(const CoreAnswer& core, PairResult& result) {
  result.method = core.method;
  result.feature = core.feature;
  result.index_a = core.index_a;
  result.index_b = core.index_b;
}

void write_distance(const Shape& a, const Pose& pose_a, const Shape& b, const CoreAnswer& core, double noise,
                    PairResult& result) {
  const double margin = a.margin + b.margin;
  const Pose to_world = core_placement(a, pose_a);
  result.has_distance = true;
  result.distance = -(core.value + margin);
  result.lower = -(core.upper + margin) - noise;
  result.upper = -(core.lower + margin) + noise;
  result.normal = to_world.rotation * core.axis;
  result.witness_a = to_world * (core.witness.a + core.axis * a.margin);
  result.witness_b = to_world * (core.witness.b - core.axis * b.margin);
}

Outcome outcome_of(int sign_of_depth) {
  return sign_of_depth < 0 ? Outcome::separated : sign_of_depth > 0 ? Outcome::penetrating : Outcome::touching;
}

// Computes the figure without float64 errors. The outcome is known and not touching.
void measure_exactly(const ExactDifference& difference, PairResult& result) {
  const bool apart = result.outcome == Outcome::separated;
  const ExactFigure figure = apart ? exact_distance(difference) : exact_depth(difference);
  result.distance = apart ? figure.value : -figure.value;
  result.lower = apart ? figure.lower : -figure.upper;
  result.upper = apart ? figure.upper : -figure.lower;
  result.normal = figure.normal;
  result.witness_a = figure.witness_a;
  result.witness_b = figure.witness_b;
  result.method = Method::exact;
}

// The verdict on flush neighbours that are not moved and whose faces are known. It takes less time than another stage in
// float64.
std::optional<Outcome> outcome_in_place(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Vec3 axis) {
  if (!a.has_faces || !b.has_faces || !is_in_place(a, pose_a) || !is_in_place(b, pose_b)) return std::nullopt;
  return outcome_by_face(WorldHull(a, pose_a), WorldHull(b, pose_b), axis);
}

// Fits the figures of float64 to an outcome that is exact.
void follow_outcome(PairResult& result) {
  const bool apart = result.outcome == Outcome::separated, overlap = result.outcome == Outcome::penetrating;
  if (!overlap) result.lower = std::fmax(result.lower, 0.0);
  if (!apart) result.upper = std::fmin(result.upper, 0.0);
  // If float64 had the wrong sign, the proven bound on the right side becomes the figure.
  if (apart && !(result.distance > 0)) result.distance = result.upper;
  if (overlap && !(result.distance < 0)) result.distance = result.lower;
  if (!apart && !overlap) result.distance = 0;
}

// Decides exactly what float64 left open about two polytopes: the sign, or a figure with wide bounds. Most pairs in
// doubt are flush neighbours, so the faces along `axis` (from A to B, in the frame of A) come first.
void settle_exactly(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, bool in_doubt, Vec3 axis,
                    Budget& budget, PairResult& result) {
  const WorldHull hull_a(a, pose_a), hull_b(b, pose_b);
  const auto difference = [&] { return ExactDifference(hull_a.vertices(), hull_b.vertices(), &budget); };
  if (in_doubt) {
    const std::optional<Outcome> by_face = outcome_by_face(hull_a, hull_b, pose_a.rotation * axis);
    result.outcome = by_face ? *by_face : outcome_of(compare_depth(difference(), Dyadic()));
    result.method = Method::exact;
  }
  if (!result.has_distance) return;
  if (result.outcome == Outcome::touching) {
    result.distance = result.lower = result.upper = 0;
  } else {
    follow_outcome(result);
    measure_exactly(difference(), result);
  }
}

// The same for cores of vertices with a margin.
void settle_grown(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Budget& budget, PairResult& result) {
  const ExactDifference difference(world_points(a, pose_a), world_points(b, pose_b), &budget);
  result.outcome = outcome_of(-compare_distance(difference, Dyadic(a.margin) + Dyadic(b.margin)));
  result.method = Method::exact;
  if (result.has_distance) follow_outcome(result);
}

// A separating axis does not give the distance: GJK measures it. Most boxes whose distance is needed are apart, and GJK
// comes first.
CoreAnswer from_sat(const MinkowskiDifference& m, const Pose& pose_a, const Pose& pose_b, Query query, double& noise,
                    PairResult& result) {
  const auto gap = [&](double lower_bound) {
    const GjkResult g = gjk(m);
    result.gjk_iterations += g.iterations;
    return from_gjk_distance(m, g, larger(g.lower, lower_bound));
  };
  const bool boxes = are_boxes(m);
  if (boxes && query == Query::distance) {
    const CoreAnswer core = gap(-INFINITY);
    if (core.upper < -m.support_error()) return core;
  }
  const SatGoal goal = query == Query::depth ? SatGoal::least_overlap : SatGoal::any_separating_axis;
  const BoxContact contact =
      boxes ? contact_of_boxes(m, pose_a, pose_b) : BoxContact{sat_polytopes(m, goal), {}, false, noise};
  const SatResult& sat = contact.sat;
  result.axes_tested += sat.axes_tested;
  if (query != Query::overlap && sat.penetration < -contact.noise) return gap(-sat.penetration);
  noise = contact.noise;
  CoreAnswer answer;
  answer.lower = sat.lower;
  answer.upper = answer.value = sat.penetration;
  answer.axis = sat.axis;
  answer.has_axis = true;
  answer.method = Method::sat;
  answer.feature = sat.feature;
  answer.index_a = sat.index_a;
  answer.index_b = sat.index_b;
  if (query != Query::overlap) {
    answer.witness = contact.sole ? contact.witness : contact_region_centre(m, sat.axis, sat.penetration);
  }
  return answer;
}

PairResult check_in_order(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Query query,
                          MethodChoice method, double enough) {
  const MinkowskiDifference m(a, pose_a, b, pose_b);
  const double margin = m.a.margin + m.b.margin;
  double noise = proof_noise(m, pose_a, pose_b);
  PairResult result;
  const bool by_sat = takes_sat(m, method);
  if (query == Query::overlap && margin == 0 && !by_sat) {
    // For curved shapes, only pairs clearly away from touching. The bounds of a depth decide whether they touch.
    const PortalResult portal = seek_portal(m, m.curved ? noise + 4 * kCurvedFacetGap * m.scale : noise);
    result.portal_rounds = portal.rounds;
    if (portal.finding != PortalFinding::open) {
      result.outcome = portal.finding == PortalFinding::apart ? Outcome::separated : Outcome::penetrating;
      result.method = Method::portal;
      return result;
    }
    if (const auto by_face = outcome_in_place(a, pose_a, b, pose_b, portal.axis)) {
      result.outcome = *by_face;
      result.method = Method::exact;
      return result;
    }
  }
  const double of_cores = query == Query::overlap ? 0 : larger(enough + noise - margin, 0);
  CoreAnswer core = by_sat ? from_sat(m, pose_a, pose_b, query, noise, result) : from_gjk(m, of_cores, result);
  if (core.lower > of_cores) query = Query::overlap;
  write_stage(core, result);
  result.outcome = classify(core, m, noise);
  const bool in_balance = result.outcome == Outcome::touching || result.outcome == Outcome::undecided;
  if (m.curved && core.has_axis && (query != Query::overlap || in_balance)) {
    polish(m, core);
    result.outcome = classify(core, m, noise);
  }
  const bool polytopes = a.is_polytope() && b.is_polytope();
  if (!polytopes && core.has_axis) straighten(core);
  if (query != Query::overlap && core.has_axis) write_distance(a, pose_a, b, core, noise, result);
  const double confirmed_below = core.method == Method::sat && !are_boxes(m) ? std::fmax(kShallow * m.scale, noise) : noise;
  const bool in_doubt = core.lower + margin <= confirmed_below && core.upper + margin >= -noise;
  const double widest = kWidestInterval * m.scale;
  const bool too_wide = result.has_distance && !(core.upper - core.lower <= widest && noise <= widest);
  if (polytopes ? in_doubt || too_wide : in_doubt && !m.curved) {
    Budget budget = Budget::that_stops(kMostExactWork);
    try {
      if (polytopes) {
        settle_exactly(a, pose_a, b, pose_b, in_doubt, core.axis, budget, result);
      } else {
        settle_grown(a, pose_a, b, pose_b, budget, result);
      }
    } catch (const BudgetSpent&) {  // the bounds of float64 stand
      if (in_doubt && result.method != Method::exact) result.outcome = Outcome::undecided;
    }
  }
  if (result.outcome == Outcome::undecided) result.reason = Reason::bounds_not_closed;
  return result;
}

PairResult check_in_any_order(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Query query,
                              MethodChoice method, double enough = INFINITY) {
  // Selected by index instead of a branch, because the order is unpredictable.
  const Shape* const shapes[2] = {&a, &b};
  const Pose* const poses[2] = {&pose_a, &pose_b};
  const bool swapped = !comes_before(a, pose_a, b, pose_b);
  PairResult result = check_in_order(*shapes[swapped], *poses[swapped], *shapes[!swapped], *poses[!swapped], query, method,
                                     enough);
  if (swapped) mirror(result);
  return result;
}

// Two shapes of the kind `box`, by the shortest way if that decides.
PairResult check_placed_boxes(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Query query) {
  PairResult result = query == Query::depth ? depth_of_boxes(a, pose_a, b, pose_b) : overlap_of_boxes(a, pose_a, b, pose_b);
  if (result.outcome == Outcome::undecided) {
    result = check_in_any_order(a, pose_a, b, pose_b, query, MethodChoice::automatic);
  }
  return result;
}

}  // namespace

MethodChoice method_from(const std::string& name) {
  if (name == "auto") return MethodChoice::automatic;
  if (name == "sat") return MethodChoice::sat;
  if (name == "gjk") return MethodChoice::gjk;
  throw std::invalid_argument("method is \"auto\", \"sat\" or \"gjk\", not \"" + name + "\"");
}

PairResult check_pair(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Query query,
                      MethodChoice method, double enough) {
  if (method != MethodChoice::gjk && query != Query::distance && a.kind == ShapeKind::box && b.kind == ShapeKind::box) {
    return check_placed_boxes(a, pose_a, b, pose_b, query);
  }
  const bool needs_faces = method == MethodChoice::sat || !a.is_polytope() || !b.is_polytope();
  if (needs_faces && !a.has_faces) return check_pair(with_faces(a), pose_a, b, pose_b, query, method, enough);
  if (needs_faces && !b.has_faces) return check_pair(a, pose_a, with_faces(b), pose_b, query, method, enough);
  return check_in_any_order(a, pose_a, b, pose_b, query, method, enough);
}

}  // namespace satcheck
