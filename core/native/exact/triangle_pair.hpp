// The contact of two closed triangles, decided by exact orientation signs.
#pragma once

#include <array>

#include "exact/predicates.hpp"

namespace satcheck {

using Corners = std::array<Vec3, 3>;

enum class TriangleContact {
  disjoint,  // no common point
  touching,  // a common point, but the open triangles do not cross
  crossing,  // the open triangles cross along a segment: each has points strictly on both sides of
              // the other one's plane there
};

inline bool is_collinear(const Corners& t, Budget* budget = nullptr) { return collinear(t[0], t[1], t[2], budget); }

// Any triangles, collinear and point-like ones included.
TriangleContact classify(const Corners& a, const Corners& b, Budget* budget = nullptr);
TriangleContact classify(const TrianglePlane& a, const Corners& b, Budget* budget = nullptr);

enum class CoplanarOverlap {
  none,      // not coplanar, or no common area
  agreeing,  // common area, normals in the same direction
  opposing,  // common area, normals in opposite directions
};

// Whether two triangles of one plane share a patch of positive area, as seen along the axis.
bool share_area(const Corners& a, const Corners& b, int drop_axis, Budget* budget = nullptr);

// Whether two triangles lie in one plane and share a patch of positive area.
CoplanarOverlap coplanar_overlap(const Corners& a, const Corners& b, Budget* budget = nullptr);

// Closed segment p q against a closed triangle, either of which may be degenerate.
bool segment_meets_triangle(Vec3 p, Vec3 q, const Corners& t, Budget* budget = nullptr);

// Where the segment p q meets a plane. p is not in the plane.
struct PlaneMeeting {
  Corners plane;
  Vec3 p, q;
};

// The ends of the segment along which crossing triangles cross.
std::array<PlaneMeeting, 2> crossing_ends(const Corners& a, const Corners& b);

// A point near the middle of the segment along which crossing triangles cross. Rounded.
Vec3 crossing_point(const Corners& a, const Corners& b);

// A common point of touching triangles. Rounded.
Vec3 contact_point(const Corners& a, const Corners& b);

}  // namespace satcheck
