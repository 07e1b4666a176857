// Which of two surfaces comes first, whatever the order in which they were named.
//
// A query is answered for the first and the second, and its answer mirrored for the other order: what hangs on the
// order of triangles or on rounding is then the same for A against B and B against A.
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

// By their boxes, then by all their vertices and triangles. True for the same mesh twice. Powers of two change nothing.
bool comes_before(const Surface& a, const Surface& b);

}  // namespace satcheck
