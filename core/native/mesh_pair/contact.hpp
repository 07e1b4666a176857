// The relation of two closed surfaces from the pairs of triangles that meet.
#pragma once

#include <vector>

#include "mesh/surface.hpp"
#include "mesh_pair/pair_facts.hpp"

namespace satcheck {

struct SurfaceContacts;

struct ContactPair {
  std::uint32_t a, b;  // triangles with a common point
};

// The facts at a generic point where two triangles cross. Usually they settle the relation.
PairFacts facts_at_crossing(const Surface& a, const Surface& b, ContactPair crossing, Budget* budget = nullptr);

// relation: boundaries that only touch count too. overlap: only common interiors count.
enum class Wanted { relation, overlap };

// Settled or complete facts; facts about contact only if wanted. `contacts`: all, whether common ones are apart or not.
PairFacts judge_contact(const Surface& a, const Surface& b, const SurfaceContacts& contacts, Wanted wanted,
                        Budget* budget = nullptr);

}  // namespace satcheck
