// Closes an open surface, so that every point has a winding number.
//
// A surface ends at the loops of its boundary (mesh/boundary.hpp). Two fills of a loop give the same winding numbers,
// except at points between them. If fills stay within the convex hull of their loop, all fills agree about inside and
// outside at all points outside of these hulls.
#pragma once

#include <memory>
#include <vector>

#include "mesh/boundary.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

struct Closing {
  // Closed: the triangles of the open surface first, then those that close it.
  std::shared_ptr<const Surface> surface;
  std::vector<Hole> holes;     // the largest first; none of sheets
  std::vector<Surface> hulls;  // closed, one for each hole: every fill of the hole lies within it
};

Closing close_surface(const Surface& open, OpenParts parts);

// The hulls of these holes of a mesh.
std::vector<Surface> hulls_of(const Mesh& mesh, const std::vector<Hole>& holes, Budget* budget = nullptr);

}  // namespace satcheck
