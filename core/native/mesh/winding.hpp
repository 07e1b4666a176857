// Exact winding numbers of points with respect to closed triangle meshes.
//
// Method: signed crossings of a segment from the point to a point outside the mesh. Exact orientation signs decide
// every crossing. If a segment meets an edge or a vertex, the next one of a fixed sequence is tried. The answer is
// therefore exact and deterministic.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "exact/predicates.hpp"
#include "mesh/bvh.hpp"

namespace satcheck {

// The first direction to try: along `axis`, up or down.
struct Heading {
  int axis = 0;
  bool upward = true;
};

// Towards the nearest wall of the box, where the segment probably meets the fewest triangles.
Heading nearest_wall(const Aabb& box, Vec3 from);

// The far end of the attempt-th segment: outside `box`, in a direction of a fixed sequence that
// starts with the heading.
Vec3 outside_point(const Aabb& box, Vec3 from, Heading first, int attempt);

// The length of the fixed sequence. Only a mesh with triangles in hundreds of directions through one point would
// exhaust it; then there is no answer.
inline constexpr int kMaxSegments = 512;

// +1 or -1 for a segment p -> far that leaves through the front or enters through the front of the
// triangle, 0 when it misses, nothing when it meets an edge or a corner or runs in the plane.
// p must not lie in the triangle, and `far` outside the mesh's box.
template <class Point>
std::optional<int> segment_crossing(const Point& p, Vec3 far, Vec3 a, Vec3 b, Vec3 c, Budget* budget = nullptr) {
  // orientation(p, far, u, v) == -orientation(far, u, v, p): an odd permutation. These signs come first: if p lies in
  // the plane of many triangles, only the sign of that plane is costly.
  const int ab = orientation(far, a, b, p, budget);
  const int bc = orientation(far, b, c, p, budget);
  if (ab * bc < 0) return 0;
  const int ca = orientation(far, c, a, p, budget);
  if (ab * ca < 0 || bc * ca < 0) return 0;
  const int to = orientation(a, b, c, far, budget);
  const int from = orientation(a, b, c, p, budget);
  if (from == 0 && to == 0) {
    if (collinear(a, b, c, budget)) return 0;
    return std::nullopt;
  }
  if (from == to || from == 0 || to == 0) return 0;
  if (ab == 0 || bc == 0 || ca == 0) return std::nullopt;
  return to;
}

// Calls cross(t, crossing) for the triangles that `counts(t)` accepts and the segment p -> far crosses. False if one of
// them cannot be decided.
template <class Point, class Counts, class Cross>
bool visit_crossings(const Mesh& mesh, const Bvh& bvh, const Point& p, Vec3 far, Counts counts, Cross cross, Budget* budget) {
  Aabb path = point_box(p);
  path.include(far);
  return visit_box(bvh, mesh, path, [&](std::uint32_t t) {
    if (!counts(t)) return true;
    const auto [a, b, c] = corners(mesh, t);
    const auto crossing = segment_crossing(p, far, a, b, c, budget);
    if (crossing.value_or(0) != 0) cross(t, *crossing);
    return crossing.has_value();
  }, budget);
}

// The sum of these crossings; nothing when one of them cannot be decided.
template <class Point, class Counts>
std::optional<int> sum_crossings(const Mesh& mesh, const Bvh& bvh, const Point& p, Vec3 far, Counts counts, Budget* budget) {
  int winding = 0;
  const auto add = [&](std::uint32_t, int crossing) { winding += crossing; };
  return visit_crossings(mesh, bvh, p, far, counts, add, budget) ? std::optional(winding) : std::nullopt;
}

// The triangles that contain p. `known` contains p and is not tested.
template <class Point>
std::vector<std::uint32_t> triangles_at(const Mesh& mesh, const Bvh& bvh, const Point& p,
                                        std::optional<std::uint32_t> known = {}, Budget* budget = nullptr) {
  std::vector<std::uint32_t> triangles;
  if (known) triangles.push_back(*known);
  visit_box(bvh, mesh, point_box(p), [&](std::uint32_t t) {
    if (t == known) return true;
    const Triangle& v = mesh.triangles[t];
    const Vec3 a = mesh.vertices[v[0]], b = mesh.vertices[v[1]], c = mesh.vertices[v[2]];
    if (point_in_triangle(p, a, b, c, budget)) triangles.push_back(t);
    return true;
  }, budget);
  return triangles;
}

// Winding number of p with respect to the triangles that `counts(t)` accepts; nothing when p lies on
// one of them.
template <class Point, class Counts>
std::optional<int> winding_number(const Mesh& mesh, const Bvh& bvh, const Point& p, Counts counts, Budget* budget = nullptr) {
  if (bvh.nodes.empty() || !meet(point_box(p), bvh.nodes[0].box)) return 0;
  for (const std::uint32_t t : triangles_at(mesh, bvh, p, {}, budget)) {
    if (counts(t)) return std::nullopt;
  }
  const Aabb& bounds = bvh.nodes[0].box;
  const Heading first = nearest_wall(bounds, rounded_point(p));
  for (int attempt = 0; attempt < kMaxSegments; ++attempt) {
    const Vec3 far = outside_point(bounds, rounded_point(p), first, attempt);
    if (const auto winding = sum_crossings(mesh, bvh, p, far, counts, budget)) return winding;
  }
  return std::nullopt;
}

template <class Point>
std::optional<int> winding_number(const Mesh& mesh, const Bvh& bvh, const Point& p, Budget* budget = nullptr) {
  return winding_number(mesh, bvh, p, [](std::uint32_t) { return true; }, budget);
}

// Winding numbers just beside a point, in front of and behind a triangle through it.
struct Beside {
  int front = 0, back = 0;
  bool on_surface = false;  // the point lies on the mesh itself

  // Whether the body ends here: at least one side has no material.
  bool is_boundary() const { return on_surface && (front == 0 || back == 0); }
  // A wall of no thickness: no material on either side.
  bool is_sheet() const { return on_surface && front == 0 && back == 0; }
};

// The winding numbers of a mesh just beside the point p of the triangle a, b, c, which need not belong to the mesh.
// Empty if p lies on a triangle of the mesh in another plane. known: the number of a, b, c if it belongs to the mesh
// and p is inside it.
template <class Point>
std::optional<Beside> winding_beside(const Mesh& mesh, const Bvh& bvh, const Point& p, Vec3 a, Vec3 b,
                                     Vec3 c, std::optional<std::uint32_t> known = {}, Budget* budget = nullptr) {
  if (bvh.nodes.empty() || !meet(point_box(p), bvh.nodes[0].box)) return Beside{};
  std::vector<std::uint32_t> here = triangles_at(mesh, bvh, p, known, budget);
  std::sort(here.begin(), here.end());
  const int axis = projection_axis(a, b, c, budget);
  const int turn = orientation_2d(a, b, c, axis, budget);
  int step = 0;               // on the way from the front to the back
  bool on_an_edge = false;    // then several triangles make up one step
  for (const std::uint32_t t : here) {
    if (t == known) {
      ++step;
      continue;
    }
    const Triangle& v = mesh.triangles[t];
    const Vec3 u[3] = {mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
    for (int i = 0; i < 3; ++i) {
      if (orientation(a, b, c, u[i], budget) != 0) return std::nullopt;
      on_an_edge = on_an_edge || orientation_2d_at(u[i], u[(i + 1) % 3], p, axis, budget) == 0;
    }
    step += turn * orientation_2d(u[0], u[1], u[2], axis, budget);
  }
  const auto elsewhere = [&](std::uint32_t t) {
    return !std::binary_search(here.begin(), here.end(), t);
  };
  const Aabb& bounds = bvh.nodes[0].box;
  const Vec3 from = rounded_point(p);
  const bool upward = bounds.max[axis] - from[axis] <= from[axis] - bounds.min[axis];
  const Heading first = here.empty() ? nearest_wall(bounds, from) : Heading{axis, upward};
  std::optional<int> front, back;
  for (int attempt = 0; attempt < kMaxSegments; ++attempt) {
    const Vec3 far = outside_point(bounds, from, first, attempt);
    const int side = here.empty() ? 1 : orientation(a, b, c, far, budget);
    if (side == 0 || (side > 0 ? front : back)) continue;
    const auto winding = sum_crossings(mesh, bvh, p, far, elsewhere, budget);
    if (!winding) continue;
    (side > 0 ? front : back) = winding;
    if (!on_an_edge) (side > 0 ? back : front) = side > 0 ? *winding + step : *winding - step;
    if (front && back) return Beside{*front, *back, !here.empty()};
  }
  return std::nullopt;
}

// The winding number of triangles, which may be an open surface, about a point on none of them: their solid angle
// divided by 4 pi, in float64. Jacobson, Kavan, Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized
// Winding Numbers" (2013); a triangle by van Oosterom, Strackee, "The Solid Angle of a Plane Triangle" (1983).
double generalized_winding_number(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, Vec3 point);

}  // namespace satcheck
