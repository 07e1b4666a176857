// Decides whether sheets cross along edges when no two of their triangles cross.
#pragma once

#include <vector>

#include "mesh_pair/contact.hpp"
#include "mesh_pair/samples.hpp"

namespace satcheck {

// Notes a crossing of sheets of two closed surfaces through edges: along a shared segment, each has points strictly on
// both sides of the other. If it finds no crossing, it tries to prove that there is none: sheets do not cross if an
// arbitrarily small translation of A separates them.
void find_sheet_crossing(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts, Samples& samples,
                         Budget* budget);

}  // namespace satcheck
