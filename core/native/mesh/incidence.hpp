// Where two triangles of different meshes meet, in terms of their features: a vertex of one on a
// triangle of the other, an edge through a triangle, two edges across each other. Which features meet
// is decided by exact signs alone, so that pieces of neighbouring triangles fit together by name.
#pragma once

#include <compare>
#include <vector>

#include "base/mesh.hpp"
#include "exact/exact_point.hpp"

namespace satcheck {

// A vertex (v, v), an edge (u, v) with u < v, or the inside of a triangle (kInside, t) of one mesh.
struct MeshFeature {
  static constexpr std::uint32_t kInside = 0xFFFFFFFF;

  std::uint32_t first = 0, second = 0;

  static MeshFeature edge(std::uint32_t u, std::uint32_t v) { return u < v ? MeshFeature{u, v} : MeshFeature{v, u}; }
  bool is_vertex() const { return first == second; }
  bool is_edge() const { return first < second; }
  auto operator<=>(const MeshFeature&) const = default;
};

// The one point that is in both features and on the border of neither.
struct Incidence {
  MeshFeature a, b;
  auto operator<=>(const Incidence&) const = default;
};

struct MeetingSide {
  Incidence from, to;
  auto operator<=>(const MeetingSide&) const = default;
};

enum class MeetingKind {
  none,
  point,    // nodes: one; several where a collinear triangle has several names for it
  segment,  // nodes: its two ends
  patch,    // sides: those of the convex polygon that coplanar triangles share
};

struct TriangleMeeting {
  MeetingKind kind = MeetingKind::none;
  std::vector<Incidence> nodes;
  std::vector<MeetingSide> sides;  // counter-clockwise about the normal of a's triangle, in no order
  bool opposed = false;     // patch: the two normals point in opposite directions
};

// The common points of two closed triangles. Two collinear triangles are taken not to meet: in a
// closed mesh what they cover belongs to other triangles too.
TriangleMeeting meet_triangles(const Mesh& a, std::uint32_t triangle_a, const Mesh& b,
                               std::uint32_t triangle_b);

// The point itself.
ExactPoint place_of(const Incidence& at, const Mesh& a, const Mesh& b);
// The same. `rounded`: its coordinates rounded to nearest, ties to even; independent of the names of features.
ExactPoint locate(const Incidence& at, const Mesh& a, const Mesh& b);

// Whether three different points are on one line, the second between the others.
bool straight(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r);

}  // namespace satcheck
