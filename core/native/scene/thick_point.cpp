#include "scene/thick_point.hpp"

#include <cmath>

#include "base/tolerances.hpp"
#include "mesh_pair/common_point.hpp"

namespace satcheck {
namespace {

constexpr int kSteps = 16;

// A computed height above the plane of a triangle, times the length of its normal, is off by no more than this, times
// the lengths of two edges and of the way from the first corner: 4 roundings of the edges and the way, 6 of the
// cross product and 3 of the dot product, rounded up.
constexpr double kHeightError = 32 * kUnitRoundoff;

// How far a point is inside the nearest plane of the triangles, for certain; negative outside. inward: unit.
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

bool has_thick_point(const Surface& a, const Surface& b, const MeshRelation& relation, double largest, double least) {
  const double enough = least + chain_rounding(largest);
  const auto common = common_point(a, b, relation, enough);
  return common && common->depth > enough;
}

// By relaxation (T. S. Motzkin, I. J. Schoenberg, "The Relaxation Method for Linear Inequalities", 1954): off the
// plane that is nearest, to a distance that shrinks, for how thick the overlap is, is not known.
bool has_thick_point(const Mesh& a, const Mesh& b, const PairResult& hulls, double least) {
  double more = 0.25 * -hulls.lower - 0.5 * least;  // half of what is left of half the depth
  Vec3 p = (hulls.witness_a + hulls.witness_b) * 0.5;
  for (int step = 0; step < kSteps && more > 0; ++step, more *= 0.5) {
    const Wall of_a = nearest_wall(a, p), of_b = nearest_wall(b, p);
    const Wall& wall = of_a.room < of_b.room ? of_a : of_b;
    if (!std::isfinite(wall.room)) break;  // without witnesses there is no place to start from
    if (wall.room > least) return true;
    p = p + wall.inward * (least + more - wall.room);
  }
  return false;
}

}  // namespace satcheck
