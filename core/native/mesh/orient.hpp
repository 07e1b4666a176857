// Repairs of the winding of a mesh.
#pragma once

#include "base/mesh.hpp"

namespace satcheck {

// The welded mesh with one winding per component, outermost closed shells outward. Repeated copies
// of a triangle are dropped when the surface is closed without them and not with them. Components with
// mixed winding are repaired when they are orientable edge-manifolds. A component whose winding is
// consistent keeps it, so cavities stay cavities, unless the whole mesh is inside out or the
// component is inside out and within no other one.
Mesh orient(const Mesh& mesh);

}  // namespace satcheck
