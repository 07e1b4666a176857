#include "ladder/touch_proof.hpp"

#include <algorithm>
#include <cmath>

#include "base/rounding.hpp"
#include "convex/narrow_phase.hpp"
#include "convex/exact_depth.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh_pair/common_point.hpp"
#include "mesh_pair/mesh_distance.hpp"

namespace satcheck {
namespace {

double depth_of_triangles(const Corners& a, const Corners& b) {
  const PairResult depth = check_pair(make_triangle(a), {}, make_triangle(b), {}, Query::depth);
  if (depth.outcome != Outcome::penetrating || !depth.has_distance) return 0;
  return std::max(-depth.upper * (1 - 2 * kUnitRoundoff), 0.0);
}

double depth_inside(const Surface& a, const Surface& b, double largest, Budget* budget) {
  return std::max(mesh_distance(a, b, INFINITY, {}, budget).distance - chain_rounding(largest), 0.0);
}

constexpr int kSteps = 16;

// The error of a computed height above the plane of a triangle, times the length of its normal, is at most this times
// the product of two edge lengths and the distance from the first corner. It covers 4 roundings of the edges and the
// offset, 6 of the cross product and 3 of the dot product, rounded up.
constexpr double kHeightError = 32 * kUnitRoundoff;

// A lower bound of the distance of a point inside the nearest plane of the triangles; negative outside. inward: unit.
struct Wall {
  double room = INFINITY;
  Vec3 inward;
};

Wall nearest_wall(const Mesh& mesh, Vec3 p) {
  Wall nearest;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto c = corners(mesh, t);
    const Vec3 u = c[1] - c[0], v = c[2] - c[0], way = p - c[0];
    const Vec3 normal = cross(u, v);
    const double length = norm(normal);
    const double error = kHeightError * norm(u) * norm(v) * norm(way);
    const double room = (-dot(normal, way) - error) / length;
    if (!(room < nearest.room)) continue;
    nearest = {room, normal * (-1 / length)};
  }
  return nearest;
}

}  // namespace

double crossing_depth(const Surface& a, const Surface& b, std::uint32_t triangle_a, std::uint32_t triangle_b) {
  return depth_of_triangles(corners(a.mesh, triangle_a), corners(b.mesh, triangle_b));
}

bool crosses_deeper(const Surface& a, const Surface& b, std::uint32_t triangle_a, std::uint32_t triangle_b, double length) {
  const Shape of_a = make_triangle(corners(a.mesh, triangle_a)), of_b = make_triangle(corners(b.mesh, triangle_b));
  const PairResult depth = check_pair(of_a, {}, of_b, {}, Query::depth);
  if (depth.outcome != Outcome::penetrating || !depth.has_distance || -depth.lower <= length) return false;
  return -depth.upper > length || compare_signed_distance(of_a, {}, of_b, {}, -length).value_or(0) < 0;
}

double nested_depth(PlacedGeometry& a, PlacedGeometry& b, const Poll& poll) {
  const double largest = larger(a.bounds().largest_coordinate(), b.bounds().largest_coordinate());
  Budget budget = budget_of_pair(*a.shared().mesh(), *b.shared().mesh(), poll);
  return depth_inside(*a.surface(), *b.surface(), largest, &budget);
}

double least_depth(const Surface& a, const Surface& b, double largest, const MeshRelation& r, Budget* budget) {
  const bool crosses = r.triangle_a != kNoIndex && r.triangle_b != kNoIndex;
  const bool nested = r.relation == Relation::contains || r.relation == Relation::inside;
  const double crossing = crosses ? crossing_depth(a, b, r.triangle_a, r.triangle_b) : 0;
  return nested ? std::max(crossing, depth_inside(a, b, largest, budget)) : crossing;
}

bool has_thick_point(const Surface& a, const Surface& b, const MeshRelation& relation, double largest, double least,
                     Budget* budget) {
  const double enough = least + chain_rounding(largest);
  const auto common = common_point(a, b, relation, enough, budget);
  return common && common->depth > enough;
}

// By relaxation (T. S. Motzkin, I. J. Schoenberg, "The Relaxation Method for Linear Inequalities", 1954): moves the
// point away from the nearest plane, to a distance that decreases, because the thickness of the overlap is unknown.
bool has_thick_point(const Mesh& a, const Mesh& b, const PairResult& hulls, double least) {
  double more = 0.25 * -hulls.lower - 0.5 * least;  // half of the rest of half the depth
  Vec3 p = (hulls.witness_a + hulls.witness_b) * 0.5;
  for (int step = 0; step < kSteps && more > 0; ++step, more *= 0.5) {
    const Wall of_a = nearest_wall(a, p), of_b = nearest_wall(b, p);
    const Wall& wall = of_a.room < of_b.room ? of_a : of_b;
    if (!std::isfinite(wall.room)) break;  // without witness points there is no start
    if (wall.room > least) return true;
    p = p + wall.inward * (least + more - wall.room);
  }
  return false;
}

}  // namespace satcheck
