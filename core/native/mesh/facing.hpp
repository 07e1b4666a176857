// How the parts of a mesh face.
#pragma once

#include <cstdint>
#include <vector>

#include "base/budget.hpp"
#include "base/edge_table.hpp"
#include "base/mesh.hpp"

namespace satcheck {

// How the parts of a mesh face whose components have one winding each. inward: the triangles to turn so that it faces
// outward. doubtful: those of each part that faces outward within one that faces inward. It is solid if that one is a room
// around it, and the wall of a cavity if that one is a solid that is inside out. And those of cavities that cross: in both
// winding numbers may cancel.
struct Facing {
  std::vector<std::uint32_t> inward;
  std::vector<std::vector<std::uint32_t>> doubtful;
};

// A mesh from orient() keeps its doubtful parts.
Facing facing_of(const Mesh& welded, Budget* budget = nullptr);

// The same of a mesh whose edges are known.
Facing facing_of(const Mesh& welded, const EdgeTable& edges, Budget* budget = nullptr);

void turn(Mesh& mesh, const std::vector<std::uint32_t>& triangles);

}  // namespace satcheck
