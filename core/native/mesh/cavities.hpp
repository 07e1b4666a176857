// Which components of a mesh are the walls of cavities.
#pragma once

#include <vector>

#include "base/budget.hpp"
#include "base/edge_table.hpp"
#include "base/mesh.hpp"
#include "base/patches.hpp"
#include "mesh/bvh.hpp"

namespace satcheck {

// The other sets, ascending, of which a triangle crosses one of this set, whose members are given.
std::vector<std::uint32_t> crossed_sets(const Mesh& mesh, const Bvh& bvh, const Labels& sets, std::uint32_t set,
                                        const std::vector<std::uint32_t>& members, Budget* budget);

// For each component the one that it belongs to: the solid whose cavity it bounds, else itself. A wall is closed, faces
// inward, and lies within an outward component that it does not cross; the walls between them are those of other solids
// between them. Signs are exact; what they leave open is no wall.
std::vector<std::uint32_t> solids_of(const Mesh& welded, const EdgeTable& edges, const Labels& components,
                                     Budget* budget = nullptr);

}  // namespace satcheck
