// The verdict on a pair, derived once from the results of all rungs.
#pragma once

#include <optional>

#include "convex/narrow_phase.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "ladder/way_within.hpp"

namespace satcheck {

struct Climb;
struct ClimbRequest;

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

Verdict verdict_of(const ClimbRequest& request, const Climb& climb);

// The signed distance of two convex bodies, which decides everything about them; null if it did not settle the pair.
const PairResult* signed_distance(const Climb& climb);

// The hole that leaves the relation open; null if there is none.
const OpenHole* hole_in_the_way(const Climb& climb);

// A proven lower bound of the distance of hulls that are apart.
double gap_of_hulls(const Climb& climb);

}  // namespace satcheck
