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

namespace satcheck {
namespace {

// Measured steps of a piece, without the queries in it.
constexpr std::uint64_t kPieceWork = 100;
// Those of the distance of two triangles.
constexpr std::uint64_t kTriangleWork = 200;

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
    if (!meet(triangle_box(c), core_)) return false;
    const NearPiece piece(solid_, c, &budget);
    const double to_surface = piece.nearest.distance;
    if (std::fmin(piece.to_triangle, to_surface + piece.radius) <= length_) return false;
    const auto winding = winding_number(solid_, piece.centre, &budget);
    if (winding && *winding != 0 && to_surface > length_) return true;
    if (winding && *winding == 0 && (piece.radius - to_surface <= length_ || !meets(c, budget))) return false;
    for (const Corners& half : halves(c)) open.push_back(half);
    return false;
  }

 private:
  bool meets(const Corners& c, Budget& budget) const {
    bool meets = false;
    visit_box(solid_.bvh, solid_.mesh, triangle_box(c), [&](std::uint32_t t) {
      budget.spend(kTriangleWork);
      meets = triangle_distance(c, corners(solid_.mesh, t), &budget).distance_squared == 0;
      return !meets;
    }, &budget);
    return meets;
  }

  const Surface& solid_;
  double length_;
  Aabb core_;
};

}  // namespace

NearPiece::NearPiece(const Surface& solid, const Corners& piece, Budget* budget)
    : centre((piece[0] + piece[1] + piece[2]) * (1.0 / 3)), nearest(nearest_point(solid, centre, budget)) {
  const Corners target = corners(solid.mesh, nearest.triangle);
  for (const Vec3 v : piece) {
    radius = std::fmax(radius, norm(v - centre));
    to_triangle = std::fmax(to_triangle, norm(nearest_on_triangle(v, target) - v));
  }
}

std::array<Corners, 2> halves(const Corners& piece) {
  int longest = 0;
  for (int i = 1; i < 3; ++i) {
    if (norm_squared(piece[(i + 1) % 3] - piece[i]) > norm_squared(piece[(longest + 1) % 3] - piece[longest])) longest = i;
  }
  const Vec3 p = piece[longest], q = piece[(longest + 1) % 3], apex = piece[(longest + 2) % 3];
  const Vec3 middle = p * 0.5 + q * 0.5;
  return {Corners{p, middle, apex}, Corners{middle, q, apex}};
}

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
