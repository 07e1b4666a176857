// Finds all pairs of triangles of two surfaces that meet. Traverses both trees at once and classifies triangles
// exactly.
#pragma once

#include <optional>
#include <vector>

#include "mesh/surface.hpp"
#include "mesh_pair/contact.hpp"

namespace satcheck {

struct SurfaceContacts {
  std::optional<ContactPair> crossing;  // the first one
  std::vector<ContactPair> contacts;    // every pair with a common point, unless the walk ended early
  std::size_t box_tests = 0, triangle_tests = 0;
};

enum class AtCrossing { stop, go_on };

SurfaceContacts find_contacts(const Surface& a, const Surface& b, AtCrossing at_crossing, Budget* budget = nullptr);

}  // namespace satcheck
