// The convex hull of points, a polytope with its features: vertices, polygonal faces, edges.
#pragma once

#include <vector>

#include "base/budget.hpp"
#include "base/vec.hpp"

namespace satcheck {

// An edge between two faces. Seen from outside, face `left` lies to the left of tail -> head.
struct PolytopeEdge {
  std::uint32_t tail, head;
  std::uint32_t left, right;
};

struct Polytope {
  // 0 point, 1 segment, 2 planar polygon, 3 solid. Decided by exact signs.
  int dimension = 0;
  std::vector<Vec3> vertices;         // the extreme points
  std::vector<std::uint32_t> source;  // index of each vertex in the input of convex_hull()

  // Outward, counter-clockwise triangulation of the boundary. Dimension 2: the polygon, front and
  // back. Dimension 0 and 1: empty.
  std::vector<Triangle> triangles;

  // Face f is the polygon face_vertex[face_offset[f] .. face_offset[f + 1]), counter-clockwise
  // seen from outside; exactly coplanar triangles are one face. Dimension 2: two faces, front and back.
  std::vector<std::uint32_t> face_offset, face_vertex;
  std::vector<Vec3> face_normal;  // unit, outward, rounded
  std::vector<PolytopeEdge> edges;

  std::size_t face_count() const { return face_normal.size(); }
};

// The convex hull of a set of points, with exact visibility tests: every input point lies inside
// or on the result, exactly. Throws std::invalid_argument on an empty or non-finite input.
//
// Method: C. Bradford Barber, David P. Dobkin, Hannu Huhdanpaa, "The Quickhull Algorithm for
// Convex Hulls" (1996), with exact orientation signs instead of its thickness tolerance.
Polytope convex_hull(const std::vector<Vec3>& points, Budget* budget = nullptr);

// The same hull without faces and edges, which takes half the time. No triangle is degenerate, but neighbours may lie in
// one plane. None if all points do.
struct HullTriangles {
  std::vector<Vec3> points;         // distinct, by x, then y, then z
  std::vector<Triangle> triangles;  // outward, counter-clockwise
};
HullTriangles hull_triangles(const std::vector<Vec3>& points, Budget* budget = nullptr);

}  // namespace satcheck
