// The verdict on a pair, drawn once from all that the rungs of its climb found.
#pragma once

#include <optional>

#include "convex/narrow_phase.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "scene/way_within.hpp"

namespace satcheck {

struct Climb;
struct ClimbRequest;

// settled: a rung answered what was asked. Else a rung above the last one may say more: bodies apart are then apart by
//     `gap`, but not beyond what was asked about, and others overlap as far as is known.
// proven: the relation is. It is not where nothing settled an overlap, where samples decided a contact, or where a hole
//     leaves the relation open (`hole_in_the_way`).
// gap: a proven lower bound of the distance; 0 where none is known.
// band: of an overlap that is settled, whether it is within the touch band. `open` and `hidden` leave a search to do.
struct Verdict {
  Relation relation = Relation::penetrating;
  bool settled = false, proven = false;
  double gap = 0;
  std::optional<BandSide> band;
};

Verdict verdict_of(const ClimbRequest& request, const Climb& climb);

// Of two convex bodies the signed distance, which says everything about them; null where it did not settle the pair.
const PairResult* signed_distance(const Climb& climb);

// The hole that leaves the relation open; null where there is none.
const OpenHole* hole_in_the_way(const Climb& climb);

// A proven lower bound of the distance of hulls that are apart.
double gap_of_hulls(const Climb& climb);

}  // namespace satcheck
