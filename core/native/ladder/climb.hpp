// The ladder: each rung settles the pairs that it can decide and leaves the others to the next rung.
//
// aabb -> obb -> hull -> triangles. The climb ends at a rung that proves a gap beyond `gap_limit`. After the triangles
// it tests the touch band, unless that needs a search. Then it derives the verdict.
#pragma once

#include <cmath>
#include <vector>

#include "convex/narrow_phase.hpp"
#include "mesh_pair/mesh_distance.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "ladder/geometry.hpp"
#include "ladder/way_within.hpp"

namespace satcheck {

enum class Rung : std::uint8_t { aabb, obb, hull, triangles };

// One pair. gap_limit: the size of a larger gap is not needed. tolerance: half width of the touch band. depth_a, depth_b:
// a point deeper than this in closed bodies A and B shows an overlap that no tolerance of their surfaces explains.
// wants_distance: measure every gap; else only gaps within the band.
struct ClimbRequest {
  PlacedGeometry* a;
  PlacedGeometry* b;
  double gap_limit, tolerance, depth_a, depth_b;
  bool wants_distance;
  // No other pair needs these bodies, so data made for this pair serve no other.
  bool alone = false;
  MethodChoice method = MethodChoice::automatic;  // between the convex hulls
  std::uint64_t steps = kNoEnd;                   // the most of the climb, beside budget_of_pair()

  // A point deeper than this in both closed bodies is beyond every band.
  double depth() const { return std::fmax(depth_a, depth_b); }
};

// sheared, unturned: why oriented boxes prove no more than the world boxes.
enum class BoxOutcome : std::uint8_t { not_asked, sheared, unturned, apart, meet };

// Index of each cost: the rungs in order, nesting after the hulls, then the touch band or the gap.
enum Clock : std::size_t { kBoxes, kOriented, kHulls, kNesting, kTriangles, kBand };

// settled: a rung answered the request. Else a higher rung may decide more: separate bodies are apart by `gap`, but not
//     beyond the gap limit, and other bodies may overlap.
// proven: the relation is proven. It is not if no rung settled an overlap, if samples decided a contact, or if a hole
//     leaves the relation open (`hole_in_the_way`).
// gap: a proven lower bound of the distance; 0: none is known.
// band: for a settled overlap, whether it is within the touch band. `open` and `hidden` need a search.
struct Verdict {
  Relation relation = Relation::penetrating;
  bool settled = false, proven = false;
  double gap = 0;
  std::optional<BandSide> band;
};

// The result and the cost of each rung; empty for rungs that the climb did not reach, or did not finish.
struct Climb {
  Verdict verdict;
  double box_gap = 0;  // a proven lower bound of the gap of the world boxes
  BoxOutcome boxes = BoxOutcome::not_asked;
  SeparatingAxis box_axis;  // if the oriented boxes are apart
  bool both_convex = false;
  std::optional<PairResult> hulls;  // for two convex bodies with the depth; else the distance, or only the outcome
  std::optional<Relation> nesting;  // of two convex bodies that overlap and whose boxes nest
  std::optional<MeshRelation> triangles;
  // For an overlap of solids deeper than the band: whether a point is deeper in both than their tolerances reach.
  // False: no such point was found, so the overlap may be thin. Sheets are not searched.
  std::optional<bool> thick;
  std::optional<double> least_depth;    // of an overlap that triangles decided, unless it is known to be thick
  std::optional<WayWithin> way_within;  // if least_depth does not prove an overlap deeper than the band
  std::optional<MeshDistance> gap;      // of separate surfaces
  std::optional<double> gap_of_holes;   // the fill of a hole may be this near, nearer than `gap`
  std::array<std::int64_t, kBand + 1> nanoseconds{};
  std::uint64_t steps = 0;  // that the climb took
  // decided: the relation is. too_few_steps: a rung was not finished, which leaves the relation open, or only the band or
  // the gap.
  bool decided = true, too_few_steps = false;
};

// From `first` to `last`. `last` runs even if it cannot settle the pair. Throws what making a body throws. poll: called
// now and then.
Climb climb(const ClimbRequest& request, Rung first, Rung last, const Poll& poll = {});

// A poll throws this to end all climbs.
struct ClimbsStopped {};

// All pairs, on `threads` threads (0: one a core). Empty for a pair whose climb threw; climb() throws again for it.
std::vector<std::optional<Climb>> climb_all(const std::vector<ClimbRequest>& requests, Rung last, unsigned threads,
                                            const Poll& poll = {});

// The verdict on a pair, derived once from the results of all rungs.
Verdict verdict_of(const ClimbRequest& request, const Climb& climb);

// The signed distance of two convex bodies, which decides everything about them; null if it did not settle the pair.
const PairResult* signed_distance(const Climb& climb);

// The hole that leaves the relation open; null if there is none.
const OpenHole* hole_in_the_way(const Climb& climb);

// The depth of the hulls of two bodies. alone: as in ClimbRequest. budget: is polled, and pays nothing.
PairResult hull_depth(PlacedGeometry& a, PlacedGeometry& b, bool alone, const Budget& budget,
                      MethodChoice method = MethodChoice::automatic);

// A proven lower bound of the distance of hulls that are apart.
double gap_of_hulls(const Climb& climb);

}  // namespace satcheck
