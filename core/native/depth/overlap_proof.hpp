// What an overlap of the two meshes after one translation proves about the translations around it.
#pragma once

#include "depth/forbidden_set.hpp"
#include "mesh/surface.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

// Where bodies overlap in several places: the place of the relation's evidence, or the thickest of some. That takes
// twice the time, and proves more where sets are many.
enum class Overlaps { first, thickest };

// A set that holds t: of the sets that were tried the one that holds it deepest; empty where none holds it. `relation` of `moved`, which is `a`
// translated by t, to `b`: with a common interior.
ForbiddenSet prove_overlap(const Surface& a, const Surface& moved, const Surface& b, Vec3 t,
                           const MeshRelation& relation, Overlaps overlaps);

}  // namespace satcheck
