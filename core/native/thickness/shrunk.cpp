#include "thickness/shrunk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/rounding.hpp"
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
// Shares of the most that a vertex may move. Sides move by kShare: the corner of a cube moves sqrt(3) times as far as its
// sides. Where that does not free the bodies, they move by half of what they lie in each other, and by kLittle more.
constexpr double kShare = 0.57, kLittle = 0.01;
// Faces with normals as opposite as that may lie in each other.
constexpr double kFacing = -0.999;
// A vertex goes as far along its way as it may once the coordinates are rounded: by the first of these shares.
constexpr double kShortened[] = {1, 0.875, 0.75, 0.5};

// A side at a vertex, and by which share of the most it has to move into the body.
struct Side {
  Vec3 normal;
  double share;
};

// For each triangle, by which share of the most its corners have to move along its normal.
using Shares = std::vector<std::array<double, 3>>;

void add(std::vector<Side>& sides, Side side) {
  for (Side& known : sides) {
    if (!(dot(known.normal, side.normal) > kSameNormal)) continue;
    known.share = larger(known.share, side.share);
    return;
  }
  sides.push_back(side);
}

// A vector along which all sides move into the body by their shares, the shortest but for rounding; zero where there is
// none.
Vec3 inwards(const std::vector<Side>& sides) {
  if (sides.empty()) return {};
  std::vector<Vec3> normals;
  for (const Side& side : sides) normals.push_back(side.normal * (1 / side.share));
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

Vec3 unit_normal(const Corners& c) {
  const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
  const double length = norm(normal);
  return length > 0 ? normal * (1 / length) : Vec3{};
}

// Whether the other face, in almost the same plane, is beyond an edge of a face, but for a little.
bool is_beside(const Corners& of, Vec3 normal, const Corners& other, double little) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 edge = of[(k + 1) % 3] - of[k], out = cross(edge, normal);
    const auto is_out = [&](Vec3 p) { return dot(out, p - of[k]) >= -little * norm(edge); };
    if (std::all_of(other.begin(), other.end(), is_out)) return true;
  }
  return false;
}

// How far corners lie behind the plane of a face, by half of which they have to move; both bodies move by the same share.
// Not where all of them lie deeper than the most that both may move.
void add_depths(std::array<double, 3>& shares, const Corners& of, const Corners& face, Vec3 normal, double most) {
  std::array<double, 3> depths;
  for (std::size_t k = 0; k < 3; ++k) depths[k] = dot(normal, face[0] - of[k]);
  if (*std::min_element(depths.begin(), depths.end()) > most) return;
  for (std::size_t k = 0; k < 3; ++k) shares[k] = std::clamp(depths[k] / most + kLittle, shares[k], 1.0);
}

// most: of both bodies together.
std::pair<Shares, Shares> depths_of_faces(const Surface& a, const Surface& b, double most, Budget& budget) {
  const std::array<double, 3> little{kLittle, kLittle, kLittle};
  std::pair<Shares, Shares> shares{Shares(a.mesh.triangles.size(), little), Shares(b.mesh.triangles.size(), little)};
  visit_box(a.bvh, a.mesh, b.bvh.nodes[0].box, [&](std::uint32_t t) {
    const Corners of_a = corners(a.mesh, t);
    const Vec3 normal = unit_normal(of_a);
    visit_box(b.bvh, b.mesh, bounds_of(of_a), [&](std::uint32_t u) {
      const Corners of_b = corners(b.mesh, u);
      const Vec3 facing = unit_normal(of_b);
      if (!(dot(normal, facing) < kFacing)) return true;
      if (is_beside(of_a, normal, of_b, most) || is_beside(of_b, facing, of_a, most)) return true;
      add_depths(shares.first[t], of_a, of_b, facing, most);
      add_depths(shares.second[u], of_b, of_a, normal, most);
      return true;
    }, &budget);
    return true;
  }, &budget);
  return shares;
}

// Moves the corners of the triangles whose boxes meet `other`.
Surface shrunk(const Surface& surface, double most, const Aabb& other, const Shares& shares) {
  const Mesh& mesh = surface.mesh;
  std::vector<bool> moves(mesh.vertices.size(), false);
  visit_box(surface.bvh, mesh, other, [&](std::uint32_t t) {
    for (const std::uint32_t v : mesh.triangles[t]) moves[v] = true;
    return true;
  });
  std::unordered_map<std::uint32_t, std::vector<Side>> sides;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& vertices = mesh.triangles[t];
    if (std::none_of(vertices.begin(), vertices.end(), [&](std::uint32_t v) { return moves[v]; })) continue;
    const Vec3 normal = unit_normal(corners(mesh, t));
    if (normal == Vec3{}) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      if (moves[vertices[k]]) add(sides[vertices[k]], {normal, shares.empty() ? kShare : shares[t][k]});
    }
  }
  Mesh moved = mesh;
  for (const auto& [vertex, here] : sides) {
    Vec3& v = moved.vertices[vertex];
    Vec3 way = inwards(here) * most;
    const double length = norm(way);
    if (length > most * kShort) way = way * (most * kShort / length);
    for (const double share : kShortened) {
      const Vec3 there = v + way * share;
      if (!(norm(there - v) <= most * kShort * (1 + 8 * kUnitRoundoff))) continue;
      v = there;
      break;
    }
  }
  return refitted_surface(surface, std::move(moved));
}

}  // namespace

bool free_when_shrunk(const Surface& a, const Surface& b, double most_a, double most_b, const Poll& poll) {
  if (!a.solid || !b.solid) throw std::invalid_argument("the thickness of an overlap needs two solids");
  if (!(most_a >= 0 && most_b >= 0)) throw std::invalid_argument("the lengths must not be negative");
  if (a.bvh.nodes.empty() || b.bvh.nodes.empty()) return true;
  const auto are_free = [&](const Shares& of_a, const Shares& of_b) {
    const Surface less_a = shrunk(a, most_a, b.bvh.nodes[0].box, of_a), less_b = shrunk(b, most_b, a.bvh.nodes[0].box, of_b);
    return mesh_relation(less_a, less_b, poll).is_free();
  };
  if (are_free({}, {})) return true;
  if (!(most_a + most_b > 0)) return false;
  try {
    Budget budget = budget_of_pair(a.mesh, b.mesh, poll);
    const auto [of_a, of_b] = depths_of_faces(a, b, most_a + most_b, budget);
    return are_free(of_a, of_b);
  } catch (const BudgetSpent&) {
    return false;
  }
}

}  // namespace satcheck
