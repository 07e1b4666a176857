// Repairs of the winding of a mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/budget.hpp"
#include "base/mesh.hpp"

namespace satcheck {

// The welded mesh with one winding for each component, and the outermost closed shells outward. Repeated copies of a
// triangle are dropped if the surface is closed only without them. Components with mixed winding are repaired if they
// are orientable edge-manifolds. A component with consistent winding keeps it, so cavities stay cavities. Exceptions:
// the whole mesh is inside out, or the component is inside out and within no other one, or it is within such a one.
// Nothing is turned if that leaves a doubt; `doubtful` then becomes true.
Mesh orient(const Mesh& mesh, Budget* budget = nullptr, bool* doubtful = nullptr);

// Shells that face outward within one that faces inward. They are solid if that one is a room around them, and walls of
// cavities if it is a solid that is inside out.
struct Doubt {
  Mesh outward;                                    // with cavities
  std::vector<std::vector<std::uint32_t>> shells;  // the triangles of each
};

// Nothing: there are no such shells. A welded mesh from orient() keeps its doubt.
std::optional<Doubt> find_doubt(const Mesh& welded, Budget* budget = nullptr);

}  // namespace satcheck
