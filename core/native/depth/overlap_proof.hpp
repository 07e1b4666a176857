// Proves from an overlap after one translation that nearby translations also leave an overlap.
#pragma once

#include "depth/forbidden_set.hpp"
#include "mesh/surface.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

// If bodies overlap in several places: use the place of the relation's evidence (first), or the thickest of several
// (thickest). The latter takes twice the time, and proves more if there are many sets.
enum class Overlaps { first, thickest };

struct OverlapProof {
  ForbiddenSet set;
  RegionPair regions;  // that it is the difference of, unless triangles prove more
};

// The set in which t is deepest, among all sets that were tried; empty if t is in none. `moved`: `a` translated by t.
// `relation`: of `moved` to `b`, with a common interior. regions_alone: triangles are not tried.
OverlapProof prove_overlap(const Surface& a, const Surface& moved, const Surface& b, Vec3 t,
                           const MeshRelation& relation, Overlaps overlaps, bool regions_alone, Budget& budget);

}  // namespace satcheck
