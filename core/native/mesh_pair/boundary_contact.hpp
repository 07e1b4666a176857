// Do the boundaries of two bodies meet?
#pragma once

#include <vector>

#include "mesh_pair/contact.hpp"
#include "mesh_pair/samples.hpp"

namespace satcheck {

// Does the closed body end everywhere on triangle t? False also where that takes more than one sample to tell.
bool is_plain_boundary(const Surface& surface, std::uint32_t t);

// By two triangles that meet and are boundary all over. Usually finds a pair, but not always.
void find_plain_contact(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts,
                        Samples& samples);

// By every corner of every piece; settles whether there is contact.
void find_any_contact(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts,
                      Samples& samples);

}  // namespace satcheck
