#include "ladder/verdict.hpp"

#include <cmath>

#include "convex/signed_comparison.hpp"
#include "ladder/climb.hpp"

namespace satcheck {
namespace {

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
