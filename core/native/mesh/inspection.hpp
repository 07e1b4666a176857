// The inspection of a mesh: it is welded, sorted, oriented on request, and measured.
#pragma once

#include <cstddef>
#include <vector>

#include "base/budget.hpp"
#include "base/mesh.hpp"
#include "mesh/boundary.hpp"
#include "mesh/topology.hpp"

namespace satcheck {

struct Inspection {
  Mesh mesh;               // welded and sorted, then oriented if the caller wants that
  bool turned = false;     // orienting changed the mesh
  bool doubtful = false;   // shells of it may be solid or cavities (mesh/facing.hpp)
  std::size_t cracks = 0;  // number of closed cracks (mesh/cracks.hpp)
  Topology topology;       // before the mesh was oriented and its cracks were closed
  Topology repaired;       // of `mesh`; not solid if it is doubtful
  std::vector<Hole> holes; // of `mesh`, the largest first
};

// Both throw BudgetSpent if orienting the mesh, closing its cracks and finding its holes take more steps than a mesh may
// (at most kMostSteps). poll: called now and then. A mesh with a boundary is oriented by with_cracks_closed().
Inspection inspect(MeshView mesh, bool orient_it, const Poll& poll = {});

// Closes the cracks of the mesh. width: points this close may be the same point.
Inspection with_cracks_closed(Inspection inspection, bool orient_it, double width, const Poll& poll = {});

}  // namespace satcheck
