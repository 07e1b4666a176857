// Removes collinear triangles from a surface.
#pragma once

#include <vector>

#include "base/mesh.hpp"

namespace satcheck {

struct Sliverless {
  Mesh mesh;                          // same number of triangles; removed ones repeat a corner
  std::vector<std::uint32_t> source;  // for each, the triangle of the given mesh that contains it
  bool changed = false;
};

// A collinear triangle closes the gap between an edge and a vertex on that edge. If the triangle across the edge is
// split at that vertex, it closes the gap itself, and no point of the surface moves. A collinear triangle is kept if
// its long edge does not belong to exactly one other triangle.
Sliverless without_slivers(const Mesh& welded);

}  // namespace satcheck
