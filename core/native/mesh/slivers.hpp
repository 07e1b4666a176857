// The same surface without triangles that are collinear.
#pragma once

#include <vector>

#include "base/mesh.hpp"

namespace satcheck {

struct Sliverless {
  Mesh mesh;                          // as many triangles; those that went repeat a corner
  std::vector<std::uint32_t> source;  // of which triangle of the given mesh each is a part
  bool changed = false;
};

// A collinear triangle closes the gap between an edge and a vertex that lies on it. Split at that
// vertex, the triangle across the edge closes it too: no point of the surface moves. A collinear
// triangle stays where its long edge does not belong to exactly one other triangle.
Sliverless without_slivers(const Mesh& welded);

}  // namespace satcheck
