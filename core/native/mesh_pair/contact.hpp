// The relation of two closed surfaces from the pairs of triangles that meet.
#pragma once

#include <vector>

#include "mesh/surface.hpp"
#include "mesh_pair/pair_facts.hpp"

namespace satcheck {

struct ContactPair {
  std::uint32_t a, b;  // triangles with a common point
};

// What a generic point shows at which two triangles cross. Usually that settles the relation.
PairFacts facts_at_crossing(const Surface& a, const Surface& b, ContactPair crossing);

// Do boundaries that only touch count, or only common interiors?
enum class Wanted { relation, overlap };

// Settled or complete facts, of the contact only where that is wanted. `contacts` holds every pair with a common point.
PairFacts judge_contact(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts, Wanted wanted);

}  // namespace satcheck
