// The faces around a straight stretch of a surface, in rotational order.
#pragma once

#include <optional>
#include <vector>

#include "overlap/meeting_nodes.hpp"

namespace satcheck {

// A face that ends at a stretch. `mesh` is 0 or 1.
struct HalfPlane {
  std::uint32_t low, high;  // the ends of the stretch, low < high
  int mesh;
  std::uint32_t triangle, face;
  bool left;  // of the way from low to high, seen from the front of the triangle
  int edge;   // the edge of the triangle in which the stretch lies, -1: none

  // The sides of a face: 2 * face is in front of it, 2 * face + 1 behind it. side_ahead: the side that comes next when
  // the half-plane turns counter-clockwise about the direction from low to high.
  std::uint32_t side_ahead() const { return 2 * face + (left ? 0 : 1); }
  std::uint32_t side_behind() const { return 2 * face + (left ? 1 : 0); }
};

// The half-planes in counter-clockwise order about the direction from low to high; coincident ones form a group. Empty
// if neither an edge of a mesh nor the crossing of two triangles gives the order, because a surface meets itself.
std::optional<std::vector<std::vector<HalfPlane>>> order_around(const Mesh& a, const Mesh& b, const MeetingNodes& nodes,
                                                                const std::vector<HalfPlane>& half_planes);

}  // namespace satcheck
