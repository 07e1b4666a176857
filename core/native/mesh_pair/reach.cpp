// Division of triangles into pieces. A piece with corners v_i, centre c and radius r around c, s(x) being the distance to
// the surface of the solid, is nowhere deeper than
//   max_i |v_i - T|   T the triangle nearest to c: the distance to a convex set is convex
//   s(c) + r          s is 1-Lipschitz
//   r - s(c)          when c is outside
// and nowhere inside if it does not meet the surface and c is outside. It has no deeper point outside of the solid's box, made smaller by the length.
#include "mesh_pair/reach.hpp"

#include <cmath>
#include <vector>

#include "base/budget.hpp"
#include "exact/triangle_distance.hpp"
#include "mesh/nearest_point.hpp"

namespace satcheck {
namespace {

// Measured steps of a piece, without the queries in it.
constexpr std::uint64_t kPieceWork = 100;
// Those of the distance of two triangles.
constexpr std::uint64_t kTriangleWork = 200;

Aabb box_of(const Corners& c) {
  Aabb box{c[0], c[0]};
  box.include(c[1]);
  box.include(c[2]);
  return box;
}

class Reach {
 public:
  Reach(const Surface& solid, double length) : solid_(solid), length_(length) {
    const Aabb& box = solid.bvh.nodes[0].box;
    const Vec3 in{length, length, length};
    core_ = {box.min + in, box.max - in};
  }

  // Puts the halves of a piece on the list if they may reach deeper. Whether a point of it does for certain.
  bool look_at(const Corners& c, std::vector<Corners>& open, Budget& budget) const {
    budget.spend(kPieceWork);
    if (!meet(box_of(c), core_)) return false;
    const Vec3 centre = (c[0] + c[1] + c[2]) * (1.0 / 3);
    double radius = 0, to_nearest = 0;
    for (const Vec3 v : c) radius = std::fmax(radius, norm(v - centre));
    const NearestPoint nearest = nearest_point(solid_, centre, &budget);
    const Corners target = corners(solid_.mesh, nearest.triangle);
    for (const Vec3 v : c) to_nearest = std::fmax(to_nearest, norm(nearest_on_triangle(v, target) - v));
    if (std::fmin(to_nearest, nearest.distance + radius) <= length_) return false;
    const auto winding = winding_number(solid_, centre, &budget);
    if (winding && *winding != 0 && nearest.distance > length_) return true;
    if (winding && *winding == 0 && (radius - nearest.distance <= length_ || !meets(c, budget))) return false;
    halve(c, open);
    return false;
  }

 private:
  bool meets(const Corners& c, Budget& budget) const {
    bool meets = false;
    visit_box(solid_.bvh, solid_.mesh, box_of(c), [&](std::uint32_t t) {
      budget.spend(kTriangleWork);
      meets = triangle_distance(c, corners(solid_.mesh, t), &budget).distance_squared == 0;
      return !meets;
    }, &budget);
    return meets;
  }

  static void halve(const Corners& c, std::vector<Corners>& open) {
    int longest = 0;
    for (int i = 1; i < 3; ++i) {
      if (norm_squared(c[(i + 1) % 3] - c[i]) > norm_squared(c[(longest + 1) % 3] - c[longest])) longest = i;
    }
    const Vec3 p = c[longest], q = c[(longest + 1) % 3], apex = c[(longest + 2) % 3];
    const Vec3 middle = p * 0.5 + q * 0.5;
    open.push_back({p, middle, apex});
    open.push_back({middle, q, apex});
  }

  const Surface& solid_;
  double length_;
  Aabb core_;
};

}  // namespace

std::optional<bool> reaches_deeper(const Mesh& surface_of, const Surface& solid, double length, std::uint64_t work) {
  if (solid.bvh.nodes.empty()) return false;
  Budget budget(work);
  const Reach reach(solid, length);
  std::vector<Corners> open, next;
  for (std::uint32_t t = 0; t < surface_of.triangles.size(); ++t) open.push_back(corners(surface_of, t));
  for (; !open.empty(); open.swap(next)) {  // large pieces first
    next.clear();
    for (const Corners& piece : open) {
      if (reach.look_at(piece, next, budget)) return true;
      if (budget.spent() > work) return std::nullopt;
    }
  }
  return false;
}

}  // namespace satcheck
