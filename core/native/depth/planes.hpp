// Planes in the space of translations.
#pragma once

#include <optional>
#include <vector>

#include "exact/triangle_pair.hpp"

namespace satcheck {

// The half-space normal . t >= offset, `normal` unit.
struct Wall {
  Vec3 normal;
  double offset;
};

// The point of least norm beyond all walls, on the last wall; empty if no point is beyond all walls. It lies on at most
// three walls, so all sets of up to three walls with the last one are tried.
std::optional<Vec3> nearest_beyond(const std::vector<Wall>& walls);

// The translations t of a body that put a corner of it into the plane of a triangle of another one, or the other way
// round: normal . t = height, `normal` unit. A way out along the normal of a face ends at such a translation, and so does
// a position in which a body fits without clearance.
struct CornerPlane {
  double height;
  int axis;  // axis of the normal, or -1
  Vec3 normal;

  double distance(Vec3 t) const;
  // The nearest of these translations to t. If the normal is along an axis, the other coordinates do not change.
  Vec3 nearest_to(Vec3 t) const;
};

// The planes for p, moved relative to q: each corner of q in the plane of p, then each corner of p in the plane of q. A
// triangle without area has no plane.
std::vector<CornerPlane> corner_planes(const Corners& p, const Corners& q);

}  // namespace satcheck
