// If all of one hull lies on or above a face plane of the other, they share at most points of that plane. Both have a
// convex outline there: the separating axis theorem in two dimensions decides whether these meet, by the lines through
// their edges. Two faces that look at each other in one plane separate their hulls without a test of other vertices.

#include "convex/separating_face.hpp"

#include <algorithm>

#include "exact/predicates.hpp"

namespace satcheck {

namespace {

// Three corners of face f, spread around it, counter-clockwise seen from outside. No corners of a face are in line.
Triangle corners_of(const Polytope& p, std::size_t f) {
  const std::uint32_t* corner = p.face_vertex.data() + p.face_offset[f];
  const std::uint32_t count = p.face_offset[f + 1] - p.face_offset[f];
  return {corner[0], corner[count / 3], corner[2 * count / 3]};
}

// A face of a hull, and its plane.
struct Face {
  const WorldHull& hull;
  std::size_t index;
  TrianglePlane plane;
};

Face face_at(const WorldHull& hull, std::size_t index) {
  const Triangle t = corners_of(hull.shape().polytope, index);
  return {hull, index, TrianglePlane(hull.vertex(t[0]), hull.vertex(t[1]), hull.vertex(t[2]))};
}

SATCHECK_WIDE std::uint32_t index_of_face(const Shape& shape, Vec3 axis) { return support_index(shape.face_normals, axis); }

// Empty for a point and a segment.
std::optional<Face> face_along(const WorldHull& hull, Vec3 axis) {
  if (hull.shape().polytope.face_count() == 0) return std::nullopt;
  return face_at(hull, index_of_face(hull.shape(), axis));
}

// A convex polygon, a segment or a point in a plane, seen along the coordinate axis `drop`.
struct Outline {
  std::vector<Vec2> corners;
  int turn = 1;  // of a polygon: the sign of its orientation, 0 if the plane is seen from its edge
};

Vec2 projected(Vec3 p, int drop) { return {p[(drop + 1) % 3], p[(drop + 2) % 3]}; }

Outline outline_of(const Face& face, int drop) {
  const Polytope& p = face.hull.shape().polytope;
  const std::uint32_t first = p.face_offset[face.index], end = p.face_offset[face.index + 1];
  Outline outline;
  outline.corners.reserve(end - first);
  for (std::uint32_t i = first; i < end; ++i) outline.corners.push_back(projected(face.hull.vertex(p.face_vertex[i]), drop));
  outline.turn = orientation_2d(face.plane.a, face.plane.b, face.plane.c, drop);
  return outline;
}

// For each vertex whether it lies in the plane; empty if a vertex lies below.
std::optional<std::vector<char>> vertices_in(const TrianglePlane& plane, const WorldHull& hull) {
  std::vector<char> in_plane(hull.shape().polytope.vertices.size());
  for (std::size_t i = 0; i < in_plane.size(); ++i) {
    const int side = plane.side(hull.vertex(i));
    if (side < 0) return std::nullopt;
    in_plane[i] = side == 0;
  }
  return in_plane;
}

// A hull has at most two vertices in a plane that supports it, or a face.
Outline outline_in_plane(const WorldHull& hull, const std::vector<char>& in_plane, int drop) {
  const Polytope& p = hull.shape().polytope;
  for (std::size_t f = 0; f < p.face_count(); ++f) {
    const auto first = p.face_vertex.begin() + p.face_offset[f], end = p.face_vertex.begin() + p.face_offset[f + 1];
    if (std::all_of(first, end, [&](std::uint32_t v) { return in_plane[v]; })) return outline_of(face_at(hull, f), drop);
  }
  Outline outline;
  for (std::size_t i = 0; i < in_plane.size(); ++i) {
    if (in_plane[i]) outline.corners.push_back(projected(hull.vertex(i), drop));
  }
  return outline;
}

// Whether all of q lies strictly beyond the line through an edge of p. A segment has two edges, one for each side.
bool some_edge_separates(const Outline& p, const Outline& q) {
  const std::size_t count = p.corners.size();
  for (std::size_t i = 0; count > 1 && i < count; ++i) {
    const Vec2 tail = p.corners[i], head = p.corners[i + 1 == count ? 0 : i + 1];
    const auto beyond = [&](Vec2 corner) { return orientation(tail, head, corner) * p.turn < 0; };
    if (std::all_of(q.corners.begin(), q.corners.end(), beyond)) return true;
  }
  return false;
}

// The verdict on two hulls on different sides of a plane, from what they have in it.
std::optional<Outcome> outcome_in_plane(const Outline& p, const Outline& q) {
  if (p.turn == 0 || q.turn == 0) return std::nullopt;
  return some_edge_separates(p, q) || some_edge_separates(q, p) ? Outcome::separated : Outcome::touching;
}

int drop_of(const Face& face) { return projection_axis(face.hull.shape().polytope.face_normal[face.index]); }

std::optional<Outcome> outcome_by_plane_of(const Face& face, const WorldHull& other) {
  const auto in_plane = vertices_in(face.plane, other);
  if (!in_plane) return std::nullopt;
  const int drop = drop_of(face);
  const Outline q = outline_in_plane(other, *in_plane, drop);
  return q.corners.empty() ? Outcome::separated : outcome_in_plane(outline_of(face, drop), q);
}

// Two faces in one plane that look at each other: each hull lies behind its own face. Empty for other faces.
std::optional<Outcome> outcome_if_flush(const Face& of_a, const Face& of_b) {
  for (Vec3 corner : {of_b.plane.a, of_b.plane.b, of_b.plane.c}) {
    if (of_a.plane.side(corner) != 0) return std::nullopt;
  }
  const int drop = drop_of(of_a);
  const Outline p = outline_of(of_a, drop), q = outline_of(of_b, drop);
  return p.turn == q.turn ? std::nullopt : outcome_in_plane(p, q);
}

}  // namespace

std::optional<Outcome> outcome_by_face(const WorldHull& a, const WorldHull& b, Vec3 axis) {
  const std::optional<Face> of_a = face_along(a, axis), of_b = face_along(b, -axis);
  std::optional<Outcome> outcome;
  if (of_a && of_b) outcome = outcome_if_flush(*of_a, *of_b);
  if (!outcome && of_a) outcome = outcome_by_plane_of(*of_a, b);
  if (!outcome && of_b) outcome = outcome_by_plane_of(*of_b, a);
  return outcome;
}

}  // namespace satcheck
