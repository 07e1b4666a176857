// The relation of two meshes, decided by exact predicates.
//
// separated    no common point, and neither contains the other
// penetrating  interiors overlap, or a surface crosses a sheet
// touching     common surface points, no overlap
// contains     b is inside the material of a without touching its surface; inside: the reverse
// coincident   the same triangles at the same place
//
// What a body is: mesh_pair/pair_facts.hpp. How an open surface is read: mesh/closing.hpp.
#pragma once

#include <cstdint>
#include <optional>

#include "mesh/surface.hpp"

namespace satcheck {

enum class Relation { separated, touching, penetrating, contains, inside, coincident };

inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFF;

// A hole that leaves the relation open: what fills it may meet the other body.
struct OpenHole {
  bool of_a = true;
  std::size_t number = 0, count = 0;  // number: from 0 on, the largest hole first
  Vec3 centre;
  double diameter = 0;
};

struct MeshRelation {
  Relation relation = Relation::separated;
  bool proven = true;  // false: a degenerate contact was decided by samples, or a hole leaves it open
  std::optional<OpenHole> hole;  // then the relation is that of the surfaces as they are
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;  // evidence
  std::optional<Vec3> point;  // a common point, rounded
  std::size_t box_tests = 0, triangle_tests = 0;
  std::size_t judged = 0;  // pairs of triangles in contact that samples had to be taken beside
};

MeshRelation mesh_relation(const Surface& a, const Surface& b);

// The same where only a common interior counts, which takes less: `separated` may be touching, and one that `contains`
// the other, or is `inside`, may reach its surface.
MeshRelation overlap_relation(const Surface& a, const Surface& b);

// The same of two closed surfaces by their points alone: sheets of the same triangles touch.
MeshRelation closed_relation(const Surface& a, const Surface& b);

// The same of two closed surfaces whose boxes differ, where one crossing settles it, or that they have no contact. It looks
// at little beyond where the boxes of the two meet.
std::optional<MeshRelation> simple_relation(const Surface& a, const Surface& b);

}  // namespace satcheck
