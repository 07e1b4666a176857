// If all of one hull lies on or above a face plane of the other, they share at most points of that plane. Both have a
// convex outline there: the separating axis theorem in two dimensions decides whether these meet, by the lines through
// their edges.

#include "convex/separating_face.hpp"

#include <algorithm>

#include "exact/predicates.hpp"

namespace satcheck {

namespace {

std::size_t face_along(const Polytope& p, Vec3 axis) {
  std::size_t best = 0;
  double most = -INFINITY;
  for (std::size_t f = 0; f < p.face_count(); ++f) {
    const double along = dot(p.face_normal[f], axis);
    if (along <= most) continue;
    most = along;
    best = f;
  }
  return best;
}

// For each vertex whether it lies in the plane; empty if a vertex lies below.
std::optional<std::vector<char>> vertices_in(const TrianglePlane& plane, const std::vector<Vec3>& vertices) {
  std::vector<char> in_plane(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const int side = plane.side(vertices[i]);
    if (side < 0) return std::nullopt;
    in_plane[i] = side == 0;
  }
  return in_plane;
}

// A convex polygon, a segment or a point in a plane, seen along the coordinate axis `drop`.
struct Outline {
  std::vector<Vec3> corners;
  int turn = 1;  // of a polygon: the sign of its orientation
};

Outline outline_of_face(const Polytope& p, std::size_t f, int drop) {
  Outline outline;
  for (std::uint32_t i = p.face_offset[f]; i < p.face_offset[f + 1]; ++i) {
    outline.corners.push_back(p.vertices[p.face_vertex[i]]);
  }
  const Triangle t = corners_of(p, f);
  outline.turn = orientation_2d(p.vertices[t[0]], p.vertices[t[1]], p.vertices[t[2]], drop);
  return outline;
}

// A hull has at most two vertices in a plane that supports it, or a face.
Outline outline_in_plane(const Polytope& p, const std::vector<char>& in_plane, int drop) {
  for (std::size_t f = 0; f < p.face_count(); ++f) {
    const auto first = p.face_vertex.begin() + p.face_offset[f], end = p.face_vertex.begin() + p.face_offset[f + 1];
    if (std::all_of(first, end, [&](std::uint32_t v) { return in_plane[v]; })) return outline_of_face(p, f, drop);
  }
  Outline outline;
  for (std::size_t i = 0; i < p.vertices.size(); ++i) {
    if (in_plane[i]) outline.corners.push_back(p.vertices[i]);
  }
  return outline;
}

// Whether all of q lies strictly beyond the line through an edge of p. A segment has two edges, one for each side.
bool some_edge_separates(const Outline& p, const Outline& q, int drop) {
  const std::size_t count = p.corners.size();
  for (std::size_t i = 0; count > 1 && i < count; ++i) {
    const Vec3 tail = p.corners[i], head = p.corners[(i + 1) % count];
    const auto beyond = [&](Vec3 corner) { return orientation_2d(tail, head, corner, drop) * p.turn < 0; };
    if (std::all_of(q.corners.begin(), q.corners.end(), beyond)) return true;
  }
  return false;
}

int largest_coordinate(Vec3 v) {
  const double x = std::fabs(v.x), y = std::fabs(v.y), z = std::fabs(v.z);
  return x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
}

std::optional<Outcome> outcome_by_face_of(const Polytope& owner, const Polytope& other, Vec3 axis) {
  if (owner.face_count() == 0) return std::nullopt;
  const std::size_t face = face_along(owner, axis);
  const Triangle t = corners_of(owner, face);
  const TrianglePlane plane(owner.vertices[t[0]], owner.vertices[t[1]], owner.vertices[t[2]]);
  const auto in_plane = vertices_in(plane, other.vertices);
  if (!in_plane) return std::nullopt;
  const int drop = largest_coordinate(owner.face_normal[face]);
  const Outline p = outline_of_face(owner, face, drop), q = outline_in_plane(other, *in_plane, drop);
  if (q.corners.empty()) return Outcome::separated;
  if (p.turn == 0 || q.turn == 0) return std::nullopt;  // the plane is seen from its edge
  const bool apart = some_edge_separates(p, q, drop) || some_edge_separates(q, p, drop);
  return apart ? Outcome::separated : Outcome::touching;
}

}  // namespace

Triangle corners_of(const Polytope& p, std::size_t f) {
  const std::uint32_t first = p.face_offset[f], end = p.face_offset[f + 1];
  Triangle best{};
  double widest = -1;
  // The widest triangle of a fan is best for the filter.
  for (std::uint32_t i = first + 1; i + 1 < end; ++i) {
    const Triangle t{p.face_vertex[first], p.face_vertex[i], p.face_vertex[i + 1]};
    const double area = norm(cross(p.vertices[t[1]] - p.vertices[t[0]], p.vertices[t[2]] - p.vertices[t[0]]));
    if (area > widest) {
      widest = area;
      best = t;
    }
  }
  return best;
}

std::optional<Outcome> outcome_by_face(const Polytope& a, const Polytope& b, Vec3 axis) {
  const std::optional<Outcome> by_a = outcome_by_face_of(a, b, axis);
  return by_a ? by_a : outcome_by_face_of(b, a, -axis);
}

}  // namespace satcheck
