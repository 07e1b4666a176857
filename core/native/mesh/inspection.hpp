// What is known of a mesh before it takes part in anything.
#pragma once

#include "base/mesh.hpp"
#include "mesh/topology.hpp"

namespace satcheck {

struct Inspection {
  Mesh mesh;          // welded and sorted; after that oriented, where that was asked for and it is closed
  bool turned;        // whether orienting it changed anything
  Topology topology;  // welded and sorted
  Topology repaired;  // of `mesh`; the same where nothing was turned
};

Inspection inspect(MeshView mesh, bool orient_it);

}  // namespace satcheck
