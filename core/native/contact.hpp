// What a contact without a transversal crossing means: overlap or mere touching.
#pragma once

#include <optional>
#include <vector>

#include "surface.hpp"

namespace satcheck {

struct ContactPair {
  std::uint32_t a, b;  // triangles with a common point
};

struct Overlap {
  std::uint32_t triangle_a, triangle_b;  // kNoTriangle where unknown
  Vec3 point;                            // where the interiors meet, rounded
};

struct ContactVerdict {
  std::optional<Overlap> overlap;
  bool proven = true;
};

// `contacts` holds every touching pair, and no pair crosses; at least one side is solid.
ContactVerdict judge_contact(const Surface& a, const Surface& b,
                             const std::vector<ContactPair>& contacts);

}  // namespace satcheck
