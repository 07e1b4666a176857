// The relation of two meshes, decided by exact predicates.
//
// separated    no common point, and neither contains the other
// penetrating  interiors overlap, or a surface crosses a sheet
// touching     common surface points, no overlap
// contains     b is inside the material of a without touching its surface; inside: the reverse
// coincident   the same triangles at the same place
//
// What a body is: mesh_pair/pair_facts.hpp. How an open surface is read: mesh/boundary.hpp.
#pragma once

#include <cstdint>
#include <optional>

#include "base/budget.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

enum class Relation { separated, touching, penetrating, contains, inside, coincident };

// A hole that leaves the relation open, because its fill may meet the other body. doubtful: it is a shell that may be solid
// or the wall of a cavity.
struct OpenHole {
  bool of_a = true;
  std::size_t number = 0, count = 0;  // number: from 0 on, the largest hole first
  Vec3 centre;
  double diameter = 0;
  bool doubtful = false;
};

struct MeshRelation {
  Relation relation = Relation::separated;
  // false: a degenerate contact was decided by samples, a hole leaves it open, or it is not decided
  bool proven = true;
  bool decided = true;  // false: deciding takes more steps than a pair may; the relation then says nothing
  std::optional<OpenHole> hole;  // if set, the relation is that of the surfaces without fills
  std::uint32_t triangle_a = kNoIndex, triangle_b = kNoIndex;  // evidence
  std::optional<Vec3> point;  // a common point, rounded
  std::size_t box_tests = 0, triangle_tests = 0;
  std::optional<std::size_t> edge_tests;  // instead of both, if outlines of prisms decided
  std::size_t judged = 0;  // pairs of triangles in contact that needed samples
  std::uint64_t steps = 0;  // that deciding took

  // Whether the bodies are proven to have no common interior.
  bool is_free() const { return proven && (relation == Relation::separated || relation == Relation::touching); }
};

// The steps that a question about a pair may take, with room for each triangle. It stops. poll: called now and then.
// most: a limit of these steps.
Budget budget_of_pair(const Mesh& a, const Mesh& b, Poll poll, std::uint64_t most = kNoEnd);
// The same for one question of a search, which asks more than one: an eighth.
Budget budget_in_search(const Mesh& a, const Mesh& b, Poll poll);

// Not decided if the budget, which stops, is spent on the way.
MeshRelation mesh_relation(const Surface& a, const Surface& b, Budget& budget);
// Within budget_of_pair().
MeshRelation mesh_relation(const Surface& a, const Surface& b, const Poll& poll = {}, std::uint64_t most = kNoEnd);

// The same if only a common interior matters, which is faster. `separated` may be touching. With `contains` or
// `inside`, the inner body may reach the surface of the outer one.
MeshRelation overlap_relation(const Surface& a, const Surface& b, Budget* budget = nullptr);

// The same for two closed surfaces by their points only: sheets with equal triangles touch.
MeshRelation closed_relation(const Surface& a, const Surface& b, Budget* budget = nullptr);

// The same for two closed surfaces with different boxes; empty unless one crossing settles the relation or there is no
// contact. It visits little outside of the intersection of the two boxes.
std::optional<MeshRelation> simple_relation(const Surface& a, const Surface& b, Budget& budget);

}  // namespace satcheck
