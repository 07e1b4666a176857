#include "mesh_pair/common_point.hpp"

#include <algorithm>

#include "base/rounding.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/winding.hpp"
#include "mesh_pair/mesh_distance.hpp"

namespace satcheck {
namespace {

// The number of halvings of the longest edge on the way from the surface inward.
constexpr int kHalvings = 40;
// The number of steps of the climb, and the share of the free ball for the first try of each step.
constexpr int kClimbSteps = 24;
constexpr double kStride = 0.9;
constexpr int kStrideHalvings = 3;
// A step has to make the free ball larger by this factor.
constexpr double kDeeper = 1 + 1.0 / 64;

bool inside_both(const Surface& a, const Surface& b, Vec3 p, Budget* budget) {
  return winding_number(a, p, budget).value_or(0) != 0 && winding_number(b, p, budget).value_or(0) != 0;
}

Vec3 unit_or_zero(Vec3 v) {
  const double length = norm(v);
  return length > 0 ? v * (1 / length) : Vec3{};
}

Vec3 inward(const Surface& s, std::uint32_t triangle) {
  if (triangle == kNoIndex) return {};
  const Corners c = corners(s.mesh, triangle);
  return -unit_or_zero(rounded_normal(c[0], c[1], c[2]));
}

double longest_edge(const Surface& s, std::uint32_t triangle) {
  if (triangle == kNoIndex) return 0;
  const Corners c = corners(s.mesh, triangle);
  return std::fmax(norm(c[1] - c[0]), std::fmax(norm(c[2] - c[1]), norm(c[0] - c[2])));
}

// If triangles meet, a common point of both. Else the middle of the triangle that lies inside the other body, because
// the way inward from a corner may run along an edge.
Vec3 starting_point(const Surface& a, const Surface& b, const MeshRelation& r) {
  if (r.triangle_a != kNoIndex && r.triangle_b != kNoIndex) return *r.point;
  const bool inner_is_a = r.triangle_a != kNoIndex;
  if (!inner_is_a && r.triangle_b == kNoIndex) return *r.point;
  const Corners c = inner_is_a ? corners(a.mesh, r.triangle_a) : corners(b.mesh, r.triangle_b);
  return (c[0] + c[1] + c[2]) * (1.0 / 3);
}

std::optional<Vec3> first_inside(const Surface& a, const Surface& b, const MeshRelation& r, Budget* budget) {
  if (!r.point) return std::nullopt;
  const Vec3 start = starting_point(a, b, r);
  const Vec3 into_a = inward(a, r.triangle_a), into_b = inward(b, r.triangle_b);
  const Vec3 ways[] = {unit_or_zero(into_a + into_b), into_a, into_b};
  double step = std::fmax(longest_edge(a, r.triangle_a), longest_edge(b, r.triangle_b));
  for (int k = 0; k < kHalvings; ++k, step *= 0.5) {
    for (const Vec3 way : ways) {
      if (way == Vec3{}) continue;
      if (inside_both(a, b, start + way * step, budget)) return start + way * step;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<CommonPoint> common_point(const Surface& a, const Surface& b, const MeshRelation& relation,
                                        double enough, Budget* budget) {
  const std::optional<Vec3> start = first_inside(a, b, relation, budget);
  if (!start) return std::nullopt;
  // No surface is within the ball that reaches to the nearer surface, unless rounding is most of what the stride leaves
  // of its radius: then the step may have left a body.
  const double certain = chain_rounding(larger(a.bvh.nodes[0].box.largest_coordinate(), b.bvh.nodes[0].box.largest_coordinate())) / (1 - kStride);
  Vec3 p = *start;
  NearestPoint on_a = nearest_point(a, p, budget), on_b = nearest_point(b, p, budget);
  for (int step = 0; step < kClimbSteps; ++step) {
    const double depth = std::fmin(on_a.distance, on_b.distance);
    if (depth > enough) break;
    const Vec3 from_a = unit_or_zero(p - on_a.point), from_b = unit_or_zero(p - on_b.point);
    const Vec3 away = on_a.distance < on_b.distance ? from_a : from_b;
    bool climbed = false;
    for (const Vec3 way : {away, unit_or_zero(from_a + from_b)}) {
      double stride = kStride * depth;
      for (int k = 0; k < kStrideHalvings && !climbed; ++k, stride *= 0.5) {
        const Vec3 q = p + way * stride;
        const NearestPoint at_a = nearest_point(a, q, budget, &on_a);
        if (at_a.distance <= depth * kDeeper) continue;
        const NearestPoint at_b = nearest_point(b, q, budget, &on_b);
        if (at_b.distance <= depth * kDeeper) continue;
        if (depth <= certain && !inside_both(a, b, q, budget)) continue;
        p = q;
        on_a = at_a;
        on_b = at_b;
        climbed = true;
      }
      if (climbed) break;
    }
    if (!climbed) break;
  }
  return CommonPoint{p, std::fmin(on_a.distance, on_b.distance)};
}

}  // namespace satcheck
