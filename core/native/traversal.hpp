// Where two surfaces meet: both trees are walked at once, their triangles classified exactly.
#pragma once

#include <optional>
#include <vector>

#include "contact.hpp"
#include "surface.hpp"

namespace satcheck {

struct SurfaceContacts {
  std::optional<ContactPair> crossing;  // the walk ends at the first one
  std::vector<ContactPair> contacts;    // every touching pair, where there is no crossing
  std::size_t box_tests = 0, triangle_tests = 0;
};

SurfaceContacts find_contacts(const Surface& a, const Surface& b);

}  // namespace satcheck
