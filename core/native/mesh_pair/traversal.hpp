// Finds all pairs of triangles of two surfaces that meet. Traverses both trees at once and classifies triangles
// exactly. Where flush bodies have many triangles in common, each of those would meet a dozen others at its corners: on
// request, they are listed only once.
#pragma once

#include <optional>
#include <vector>

#include "mesh/surface.hpp"
#include "mesh_pair/contact.hpp"

namespace satcheck {

struct SurfaceContacts {
  std::optional<ContactPair> crossing;  // the first one
  std::vector<ContactPair> contacts;    // every pair with a common point, unless the walk ended early
  // Common triangles, in regions that have the same winding numbers (common_triangles.hpp). `contacts` has no pairs of
  // two of them.
  std::vector<std::vector<ContactPair>> common;
  std::size_t box_tests = 0, triangle_tests = 0;

  bool any() const { return !contacts.empty() || !common.empty(); }
  ContactPair first() const { return contacts.empty() ? common[0][0] : contacts[0]; }
};

// stop_at_many: the walk also ends once many pairs meet.
enum class AtCrossing { stop, go_on, stop_at_many };

// many: if more pairs meet, and many of them are common triangles, these are apart.
inline constexpr std::size_t kManyContacts = 4096;
SurfaceContacts find_contacts(const Surface& a, const Surface& b, AtCrossing at_crossing, Budget* budget = nullptr,
                              std::size_t many = SIZE_MAX);

}  // namespace satcheck
