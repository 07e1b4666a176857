// Which of two surfaces comes first, independent of the order in which they are given.
//
// A query is always answered in this order, and its answer is mirrored for the other one. So rounding and the order of
// triangles affect A against B and B against A in the same way.
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

// By their boxes, then by all their vertices and triangles. True for the same mesh twice. Powers of two change nothing.
bool comes_before(const Surface& a, const Surface& b);

}  // namespace satcheck
