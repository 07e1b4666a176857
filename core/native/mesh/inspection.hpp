// What is known of a mesh before it takes part in anything.
#pragma once

#include <cstddef>
#include <vector>

#include "base/mesh.hpp"
#include "mesh/boundary.hpp"
#include "mesh/topology.hpp"

namespace satcheck {

struct Inspection {
  Mesh mesh;               // welded and sorted, then oriented if the caller wants that
  bool turned = false;     // whether orienting it changed anything
  std::size_t cracks = 0;  // closed (mesh/cracks.hpp)
  Topology topology;       // welded and sorted
  Topology repaired;       // of `mesh`
  std::vector<Hole> holes; // of `mesh`, the largest first
};

Inspection inspect(MeshView mesh, bool orient_it);

// The same with the cracks of the mesh closed. width: points within it may be the same point.
Inspection with_cracks_closed(Inspection inspection, bool orient_it, double width);

}  // namespace satcheck
