// Repairs of the winding of a mesh.
#pragma once

#include "base/budget.hpp"
#include "base/mesh.hpp"

namespace satcheck {

// The welded mesh with one winding for each component, and the outermost closed shells outward. Repeated copies of a
// triangle are dropped if the surface is closed only without them. Components with mixed winding are repaired if they
// are orientable edge-manifolds. A component with consistent winding keeps it, so cavities stay cavities. Exceptions:
// the whole mesh is inside out, or the component is inside out and within no other one, or it is within such a one.
// Nothing is turned if that leaves parts doubtful; `doubtful` then becomes true.
Mesh orient(const Mesh& mesh, Budget* budget = nullptr, bool* doubtful = nullptr);

}  // namespace satcheck
