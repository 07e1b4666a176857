#include "thickness/shrunk.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "base/rounding.hpp"
#include "exact/triangle_distance.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "thickness/nearest_to_zero.hpp"

namespace satcheck {
namespace {

// Normals this close to each other, as the cosine of their angle, count as one.
constexpr double kSameNormal = 1 - 1e-6;
// Of more normals at a vertex, the mean is taken.
constexpr std::size_t kMostNormals = 8;
// What is moved by a length is moved by less, to rounding.
constexpr double kShort = 1 - 1e-6;
// A side moves by this share of the most that a vertex may move: the corner of a cube moves sqrt(3) times as far as its
// sides.
constexpr double kShare = 0.57;
// A triangle narrower than this share of its length, and than a vertex may move, is no side, as those that close cracks.
// The sides of a long and finely faceted shaft are wider.
constexpr double kNarrow = 0x1p-13;
// Few cracks of float32 are wider, as a share of the largest coordinate.
constexpr double kCrack = 0x1p-17;
// Triangles near a corner of such a one that are looked at: more are facets finer than the length.
constexpr int kMostNear = 64;

void add(std::vector<Vec3>& normals, Vec3 normal) {
  for (const Vec3 known : normals) {
    if (dot(known, normal) > kSameNormal) return;
  }
  normals.push_back(normal);
}

// A vector along which all sides move into the body by 1; zero where there is none.
Vec3 inwards(const std::vector<Vec3>& normals) {
  if (normals.empty()) return {};
  Vec3 way;
  if (normals.size() <= kMostNormals) {
    way = nearest_to_zero(normals);
  } else {
    for (const Vec3 normal : normals) way = way + normal;
  }
  double least = INFINITY;
  for (const Vec3 normal : normals) least = smaller(least, dot(normal, way));
  return least > 0 ? way * (-1 / least) : Vec3{};
}

// The normal of a side; empty if the triangle is none.
std::optional<Vec3> side(const Corners& c, double width) {
  const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
  const double twice_area = norm(normal), longest = std::max({norm(c[1] - c[0]), norm(c[2] - c[1]), norm(c[0] - c[2])});
  if (!(twice_area > std::min(width, kNarrow * longest) * longest)) return std::nullopt;
  return normal * (1 / twice_area);
}

// Moves the corners of the triangles whose boxes meet `other`, each away from the sides around it. A corner of a narrow
// triangle lies on sides of which it is no corner.
Surface shrunk(const Surface& surface, double most, const Aabb& other) {
  const Mesh& mesh = surface.mesh;
  std::vector<bool> moves(mesh.vertices.size(), false), is_loose(mesh.vertices.size(), false);
  visit_box(surface.bvh, mesh, other, [&](std::uint32_t t) {
    for (const std::uint32_t v : mesh.triangles[t]) moves[v] = true;
    return true;
  });
  double farthest = 0;
  for (const Vec3 v : mesh.vertices) farthest = std::max({farthest, std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  const double width = std::min(most, kCrack * farthest);
  std::unordered_map<std::uint32_t, std::vector<Vec3>> normals;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& vertices = mesh.triangles[t];
    if (std::none_of(vertices.begin(), vertices.end(), [&](std::uint32_t v) { return moves[v]; })) continue;
    const std::optional<Vec3> normal = side(corners(mesh, t), width);
    for (const std::uint32_t v : vertices) {
      if (!normal) is_loose[v] = true;
      if (normal && moves[v]) add(normals[v], *normal);
    }
  }
  Mesh moved = mesh;
  for (auto& [vertex, here] : normals) {
    Vec3& v = moved.vertices[vertex];
    const Vec3 reach = Vec3{1, 1, 1} * most;
    if (is_loose[vertex]) {
      int seen = 0;
      visit_box(surface.bvh, mesh, {v - reach, v + reach}, [&](std::uint32_t t) {
        const Corners c = corners(mesh, t);
        const std::optional<Vec3> normal = side(c, width);
        if (normal && norm(nearest_on_triangle(v, c) - v) <= most) add(here, *normal);
        return ++seen < kMostNear;
      });
    }
    Vec3 way = inwards(here) * (kShare * most);
    const double length = norm(way);
    if (length > most * kShort) way = way * (most * kShort / length);
    const Vec3 there = v + way;
    if (norm(there - v) <= most * kShort * (1 + 8 * kUnitRoundoff)) v = there;
  }
  return refitted_surface(surface, std::move(moved));
}

}  // namespace

bool free_when_shrunk(const Surface& a, const Surface& b, double most_a, double most_b, const Poll& poll) {
  if (!a.solid || !b.solid) throw std::invalid_argument("the thickness of an overlap needs two solids");
  if (!(most_a >= 0 && most_b >= 0)) throw std::invalid_argument("the lengths must not be negative");
  if (a.bvh.nodes.empty() || b.bvh.nodes.empty()) return true;
  const Surface less_a = shrunk(a, most_a, b.bvh.nodes[0].box), less_b = shrunk(b, most_b, a.bvh.nodes[0].box);
  return mesh_relation(less_a, less_b, poll).is_free();
}

}  // namespace satcheck
