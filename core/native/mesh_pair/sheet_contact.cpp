// Near an interior point a surface is a disk that parts its surroundings in two. Two such disks that
// share only that point do not cross, for a disk without one point is connected. So a crossing runs
// along a segment, and when no two open triangles cross, the segment lies on an edge:
//
// * an edge of one surface in a triangle of the other: they cross if the two triangles at the edge
//   leave to strictly different sides of that triangle's plane;
// * on edges of both: they cross if, turning around the common line, the triangles of one surface
//   alternate with those of the other.
#include "mesh_pair/sheet_contact.hpp"

#include <array>
#include <unordered_map>

#include "base/edge_table.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/winding.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {
namespace {

// An edge of exactly two triangles and the corners across from it.
struct Hinge {
  Vec3 p, q;
  std::array<Vec3, 2> wings;
};

// The hinges of the triangles in contact, by triangle.
class Hinges {
 public:
  Hinges(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
    std::vector<bool> wanted(mesh.triangles.size(), false);
    for (const std::uint32_t t : triangles) wanted[t] = true;
    const EdgeTable edges(mesh.vertices.size(), mesh.triangles);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto h = edges.half_edges(e);
      if (h.size() != 2 || !(wanted[h[0] / 3] || wanted[h[1] / 3])) continue;
      const auto at = [&](std::uint32_t half_edge, std::uint32_t step) {
        return mesh.vertices[mesh.triangles[half_edge / 3][(half_edge % 3 + step) % 3]];
      };
      const Hinge hinge{at(h[0], 0), at(h[0], 1), {at(h[0], 2), at(h[1], 2)}};
      for (const std::uint32_t half_edge : h) by_triangle_[half_edge / 3].push_back(hinge);
    }
  }

  const std::vector<Hinge>& of(std::uint32_t triangle) const {
    static const std::vector<Hinge> none;
    const auto found = by_triangle_.find(triangle);
    return found == by_triangle_.end() ? none : found->second;
  }

 private:
  std::unordered_map<std::uint32_t, std::vector<Hinge>> by_triangle_;
};

// Does the segment p q, in the plane of t, run through the open triangle?
bool runs_through(Vec3 p, Vec3 q, const Corners& t) {
  const int axis = projection_axis(rounded_normal(t[0], t[1], t[2]));
  const int turn = orientation_2d(t[0], t[1], t[2], axis);
  int left = 0, right = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 u = t[i], v = t[(i + 1) % 3];
    if (turn * orientation_2d(u, v, p, axis) <= 0 && turn * orientation_2d(u, v, q, axis) <= 0) return false;
    const int side = orientation_2d(p, q, u, axis);
    left += side > 0 ? 1 : 0;
    right += side < 0 ? 1 : 0;
  }
  return left > 0 && right > 0;
}

bool crosses_triangle(const Hinge& hinge, const Corners& t) {
  const auto side = [&](Vec3 p) { return orientation(t[0], t[1], t[2], p); };
  if (collinear(t[0], t[1], t[2]) || side(hinge.p) != 0 || side(hinge.q) != 0) return false;
  return side(hinge.wings[0]) * side(hinge.wings[1]) < 0 && runs_through(hinge.p, hinge.q, t);
}

// Collinear segments that share more than a point.
bool share_length(const Hinge& a, const Hinge& b) {
  if (!collinear(a.p, a.q, b.p) || !collinear(a.p, a.q, b.q)) return false;
  const int axis = a.p.x != a.q.x ? 0 : a.p.y != a.q.y ? 1 : 2;
  const auto low = [&](const Hinge& h) { return std::fmin(h.p[axis], h.q[axis]); };
  const auto high = [&](const Hinge& h) { return std::fmax(h.p[axis], h.q[axis]); };
  return low(a) < high(b) && low(b) < high(a);
}

// Turning around the line p q one way from wing u, is x met before v? orientation(p, q, u, w) > 0
// when the turn from u to w is less than half of one.
bool strictly_between(Vec3 p, Vec3 q, Vec3 u, Vec3 v, Vec3 x) {
  const int u_v = orientation(p, q, u, v), u_x = orientation(p, q, u, x), x_v = orientation(p, q, x, v);
  if (u_v > 0) return u_x > 0 && x_v > 0;
  if (u_v < 0) return u_x > 0 || x_v > 0;
  return u_x > 0;  // u and v opposite each other
}

bool same_half_plane(Vec3 p, Vec3 q, Vec3 u, Vec3 v) {
  if (orientation(p, q, u, v) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int side = orientation_2d(p, q, u, axis);
    if (side != 0) return side == orientation_2d(p, q, v, axis);
  }
  return true;  // a collinear triangle: no side to speak of
}

bool alternate(const Hinge& a, const Hinge& b) {
  const Vec3 p = a.p, q = a.q;
  if (same_half_plane(p, q, a.wings[0], a.wings[1])) return false;
  for (const Vec3& u : a.wings) {
    for (const Vec3& v : b.wings) {
      if (same_half_plane(p, q, u, v)) return false;
    }
  }
  return strictly_between(p, q, a.wings[0], a.wings[1], b.wings[0]) !=
         strictly_between(p, q, a.wings[0], a.wings[1], b.wings[1]);
}

std::vector<std::uint32_t> triangles_of(const std::vector<ContactPair>& contacts,
                                        std::uint32_t ContactPair::*side) {
  std::vector<std::uint32_t> result;
  for (const ContactPair& c : contacts) result.push_back(c.*side);
  return result;
}

}  // namespace

ContactVerdict judge_sheet_contact(const Surface& a, const Surface& b,
                                   const std::vector<ContactPair>& contacts) {
  const Hinges hinges_a(a.mesh, triangles_of(contacts, &ContactPair::a));
  const Hinges hinges_b(b.mesh, triangles_of(contacts, &ContactPair::b));
  ContactVerdict verdict;
  for (const ContactPair& c : contacts) {
    const Corners ta = corners(a.mesh, c.a), tb = corners(b.mesh, c.b);
    if (coplanar_overlap(ta, tb) != CoplanarOverlap::none) verdict.proven = false;
    for (const Hinge& h : hinges_a.of(c.a)) {
      if (crosses_triangle(h, tb)) return {Evidence{c.a, c.b, contact_point(ta, tb)}, true};
      for (const Hinge& k : hinges_b.of(c.b)) {
        if (share_length(h, k) && alternate(h, k)) {
          return {Evidence{c.a, c.b, contact_point(ta, tb)}, true};
        }
      }
    }
    for (const Hinge& k : hinges_b.of(c.b)) {
      if (crosses_triangle(k, ta)) return {Evidence{c.a, c.b, contact_point(ta, tb)}, true};
    }
  }
  return verdict;
}

}  // namespace satcheck
