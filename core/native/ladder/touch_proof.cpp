#include "ladder/touch_proof.hpp"

#include <algorithm>

#include "base/rounding.hpp"
#include "convex/narrow_phase.hpp"
#include "convex/signed_comparison.hpp"
#include "exact/triangle_pair.hpp"
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
  double largest = 0;
  for (const Aabb& box : {a.bounds(), b.bounds()}) largest = std::max({largest, max_abs(box.min), max_abs(box.max)});
  Budget budget = budget_of_pair(*a.shared().mesh(), *b.shared().mesh(), poll);
  return depth_inside(*a.surface(), *b.surface(), largest, &budget);
}

double least_depth(const Surface& a, const Surface& b, double largest, const MeshRelation& r, Budget* budget) {
  const bool crosses = r.triangle_a != kNoTriangle && r.triangle_b != kNoTriangle;
  const bool nested = r.relation == Relation::contains || r.relation == Relation::inside;
  const double crossing = crosses ? crossing_depth(a, b, r.triangle_a, r.triangle_b) : 0;
  return nested ? std::max(crossing, depth_inside(a, b, largest, budget)) : crossing;
}

}  // namespace satcheck
