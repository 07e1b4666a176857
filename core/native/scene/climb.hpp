// The ladder: each rung settles what it can prove about a pair and leaves the rest to the next.
//
// aabb -> obb -> hull -> triangles. A rung that proves the bodies apart by more than was asked about ends the climb.
// After the triangles it tests the touch band, as far as that needs no search. Then it draws the verdict.
#pragma once

#include <vector>

#include "convex/narrow_phase.hpp"
#include "mesh_pair/mesh_distance.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "scene/geometry.hpp"
#include "scene/verdict.hpp"
#include "scene/way_within.hpp"

namespace satcheck {

enum class Rung : std::uint8_t { aabb, obb, hull, triangles };

// One pair. asked_gap: a gap beyond this is not asked about. tolerance: half width of the touch band.
// wants_distance: of bodies apart, however far; else a gap is measured as far as the band reaches.
struct ClimbRequest {
  PlacedGeometry* a;
  PlacedGeometry* b;
  double asked_gap, tolerance;
  bool wants_distance;
  // No other pair asks for anything of these bodies: what is made for this one serves no other.
  bool alone = false;
  MethodChoice method = MethodChoice::automatic;  // between the convex hulls
};

// sheared, unturned: why oriented boxes say no more than the world boxes.
enum class BoxOutcome : std::uint8_t { not_asked, sheared, unturned, apart, meet };

// The places of costs: of the rungs in their order, nesting behind the hulls, and of the touch band or the gap.
enum Clock : std::size_t { kBoxes, kOriented, kHulls, kNesting, kTriangles, kBand };

// What each rung found, and what it cost; nothing where the climb did not get so far.
struct Climb {
  Verdict verdict;
  double box_gap = 0;  // a proven lower bound of the gap of the world boxes
  BoxOutcome boxes = BoxOutcome::not_asked;
  Feature box_feature = Feature::none;
  bool both_convex = false;
  std::optional<PairResult> hulls;  // of two convex bodies the depth; else the distance, or the overlap alone
  std::optional<Relation> nesting;  // of two convex bodies that overlap and whose boxes nest
  std::optional<MeshRelation> triangles;
  std::optional<double> least_depth;  // of an overlap that triangles decided, and a band that is not 0
  std::optional<WayWithin> way_within;  // of one that least_depth does not prove deeper than the band
  std::optional<MeshDistance> gap;      // of surfaces apart
  std::optional<double> gap_of_holes;  // what fills a hole may be as near as this, and nearer than `gap`
  std::array<std::int64_t, kBand + 1> nanoseconds{};
};

// From `first` up to `last`, which is taken even where what it finds cannot settle the pair. Throws what the
// making of a body throws.
Climb climb(const ClimbRequest& request, Rung first, Rung last);

// All of them, on `threads` threads (0: one a core). Nothing for a pair of which the climb threw: asked alone it
// throws again.
std::vector<std::optional<Climb>> climb_all(const std::vector<ClimbRequest>& requests, Rung last, unsigned threads);

}  // namespace satcheck
