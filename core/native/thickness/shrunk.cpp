#include "thickness/shrunk.hpp"

#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "base/rounding.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/surface_order.hpp"
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

struct InOrder {
  bool operator()(Vec3 p, Vec3 q) const { return coordinates_less(p, q); }
};

// The unit normals at a place.
using Normals = std::map<Vec3, std::vector<Vec3>, InOrder>;

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

Surface shrunk(const Surface& surface, double most) {
  const Mesh& mesh = surface.mesh;
  Normals normals;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners c = corners(mesh, t);
    const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
    const double length = norm(normal);
    if (!(length > 0)) continue;
    for (const Vec3 corner : c) add(normals[corner], normal * (1 / length));
  }
  Mesh moved = mesh;
  for (Vec3& v : moved.vertices) {
    const auto known = normals.find(v);
    if (known == normals.end()) continue;
    Vec3 way = inwards(known->second) * (kShare * most);
    const double length = norm(way);
    if (length > most * kShort) way = way * (most * kShort / length);
    const Vec3 there = v + way;
    if (norm(there - v) <= most * kShort * (1 + 8 * kUnitRoundoff)) v = there;
  }
  return make_surface(std::move(moved), true);
}

bool is_free(const Surface& a, const Surface& b) {
  const MeshRelation found = mesh_relation(a, b);
  return found.proven && (found.relation == Relation::separated || found.relation == Relation::touching);
}

}  // namespace

bool free_when_shrunk(const Surface& a, const Surface& b, double most_a, double most_b) {
  if (!a.solid || !b.solid) throw std::invalid_argument("the thickness of an overlap needs two solids");
  if (!(most_a >= 0 && most_b >= 0)) throw std::invalid_argument("the lengths must not be negative");
  const Surface less_a = shrunk(a, most_a), less_b = shrunk(b, most_b);
  return comes_before(a, b) ? is_free(less_a, less_b) : is_free(less_b, less_a);
}

}  // namespace satcheck
