// All common points of two surfaces: curves along which they cross or touch, patches in which faces
// lie in each other, and points.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/surface.hpp"
#include "mesh_pair/contact.hpp"

namespace satcheck {

// A polyline. A closed one does not repeat its first point. It does not branch: where more than two meet, each ends.
struct ContactCurve {
  std::vector<Vec3> points;
  bool closed = false;
  double length = 0;
};

// A polygon with holes in a plane: the outer outline first, counter-clockwise about `normal`.
struct ContactPatch {
  std::vector<std::vector<Vec3>> outlines;
  Vec3 normal;           // unit, of a's surface
  bool opposed = false;  // the surfaces face each other there
  double area = 0;
};

// Curves by decreasing length, patches by decreasing area; no contact is in two lists. Points are exact intersections,
// each coordinate rounded once. Points in the middle of a straight line are left out.
struct SurfaceIntersection {
  std::vector<ContactCurve> curves;
  std::vector<ContactPatch> patches;
  std::vector<Vec3> points;
  std::vector<ContactPair> triangle_pairs;  // sorted: all that have a common point
  bool complete = true;  // false: more pairs meet than allowed, or `within_budget` is false; nothing is listed
  bool within_budget = true;
};

// Swapping a and b only swaps the pairs and reverses opposed patches. budget: that stops, see budget_of_pair().
SurfaceIntersection surface_intersection(const Surface& a, const Surface& b, std::size_t max_pairs,
                                         Budget* budget = nullptr);

}  // namespace satcheck
