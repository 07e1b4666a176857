// Decides whether the boundaries of two bodies meet.
#pragma once

#include <vector>

#include "mesh_pair/contact.hpp"
#include "mesh_pair/samples.hpp"

namespace satcheck {

// Whether the closed body ends everywhere on triangle t. Also false if more than one sample is needed to decide.
bool is_plain_boundary(const Surface& surface, std::uint32_t t, Budget* budget = nullptr);

// Searches two triangles that meet and are all boundary. Usually finds a pair, but not always.
void find_plain_contact(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts,
                        Samples& samples, Budget* budget);

// Tests every corner of every piece. Decides whether there is contact.
void find_any_contact(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts,
                      Samples& samples, Budget* budget);

}  // namespace satcheck
