// A canonical order of two surfaces, independent of the order in which they are given.
//
// A query is always answered in this order, and its answer is mirrored for the other one. So rounding and the order of
// triangles affect A against B and B against A in the same way.
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

// Compares their boxes, then all vertices and triangles. True for two equal meshes. Scaling by powers of two does not
// change the result.
bool comes_before(const Surface& a, const Surface& b);

}  // namespace satcheck
