// Repairs of the winding of a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "base/budget.hpp"
#include "base/mesh.hpp"

namespace satcheck {

// The welded mesh with one winding for each component, and the outermost closed shells outward. Repeated copies of a
// triangle are dropped if the surface is closed only without them. Components with mixed winding are repaired if they
// are orientable edge-manifolds. A component with consistent winding keeps it, so cavities stay cavities. Exceptions:
// the whole mesh is inside out, or the component is inside out and within no other one, or it is within such a one.
// Nothing is turned if that leaves parts doubtful; `doubtful` then becomes true.
Mesh orient(const Mesh& mesh, Budget* budget = nullptr, bool* doubtful = nullptr);

// How the parts of a mesh face whose components have one winding each. inward: the triangles to turn so that it faces
// outward. doubtful: those of each part that faces outward within one that faces inward. It is solid if that one is a room
// around it, and the wall of a cavity if that one is a solid that is inside out.
struct Facing {
  std::vector<std::uint32_t> inward;
  std::vector<std::vector<std::uint32_t>> doubtful;
};

// A mesh from orient() keeps its doubtful parts.
Facing facing_of(const Mesh& welded, Budget* budget = nullptr);

void turn(Mesh& mesh, const std::vector<std::uint32_t>& triangles);

}  // namespace satcheck
