// Do sheets cross along edges, where no two of their triangles cross?
#pragma once

#include <vector>

#include "mesh_pair/contact.hpp"
#include "mesh_pair/samples.hpp"

namespace satcheck {

// Notes a crossing of sheets of two closed surfaces that runs through edges: along a shared segment each has
// points strictly on both sides of the other. Where it finds none it proves that there is none, or fails: sheets
// do not cross where an arbitrarily small translation of A frees them of each other.
void find_sheet_crossing(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts, Samples& samples);

}  // namespace satcheck
