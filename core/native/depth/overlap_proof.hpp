// What an overlap of the two meshes after one translation proves about the translations around it.
#pragma once

#include <cstdint>

#include "depth/forbidden_set.hpp"
#include "mesh/surface.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

struct OverlapProof {
  ForbiddenSet set;        // holds the translation, deeper than any other that was tried; empty: none does
  std::uint64_t work = 0;  // units of depth_search.hpp
};

// `relation` of `moved`, which is `a` translated by t, to `b`: with a common interior.
OverlapProof prove_overlap(const Surface& a, const Surface& moved, const Surface& b, Vec3 t,
                           const MeshRelation& relation);

}  // namespace satcheck
