// How an open surface is closed, so that every point has a winding number.
//
// A surface ends at the loops of its boundary (mesh/boundary.hpp). Whatever fills a loop adds the same winding
// numbers everywhere but within the fill. So if a fill stays within the convex hull of its loop, inside and
// outside are the same for every fill at all points outside of these hulls.
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
std::vector<Surface> hulls_of(const Mesh& mesh, const std::vector<Hole>& holes);

}  // namespace satcheck
