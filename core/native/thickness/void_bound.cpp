#include "thickness/void_bound.hpp"

#include <array>
#include <cmath>

namespace satcheck {
namespace {

// Measured steps of a plane that is held against a cell.
constexpr std::uint64_t kPlaneWork = 20;

// normal . p > height is beyond it; the patch is, and `hollow` is not.
std::optional<HalfSpace> wall_of(const ConvexPatches& patches, const Patch& patch, Vec3 hollow, double rounding) {
  const double side = dot(patch.normal, hollow - patches.origin(patch));
  const Vec3 normal = patch.normal * (side > 0 ? -1.0 : 1.0);
  double height = INFINITY;
  for (std::uint32_t i = 0; i < patch.count; ++i) height = smaller(height, dot(normal, patches.outlines[patch.first + i]));
  height -= patch.slack + rounding;
  if (!(dot(normal, hollow) < height - rounding)) return std::nullopt;
  return HalfSpace{normal, height};
}

// Whether corners of a box are outside of a body.
class BoxCorners {
 public:
  BoxCorners(const TwoBodies& bodies, int body, const Aabb& box, Budget& budget)
      : bodies_(bodies), body_(body), box_(box), budget_(budget) {}

  // Of the one that is farthest along the normal, unless it is not beyond the plane.
  bool is_free_beyond(const HalfSpace& plane) {
    const std::size_t k = (plane.normal.x > 0 ? 1u : 0u) + (plane.normal.y > 0 ? 2u : 0u) + (plane.normal.z > 0 ? 4u : 0u);
    const Vec3 corner{k & 1 ? box_.max.x : box_.min.x, k & 2 ? box_.max.y : box_.min.y, k & 4 ? box_.max.z : box_.min.z};
    if (dot(plane.normal, corner) <= plane.height) return true;
    if (!outside_[k]) outside_[k] = bodies_.is_outside(body_, corner, budget_);
    return *outside_[k];
  }

 private:
  const TwoBodies& bodies_;
  int body_;
  Aabb box_;
  Budget& budget_;
  std::array<std::optional<bool>, 8> outside_;
};

}  // namespace

double bound_around(const CellVoid& of, const TwoBodies& bodies, double enough, Budget& budget) {
  const int other = 1 - of.body;
  const double rounding = bodies.rounding(), less = bodies.less(other);
  // A point that is this far beyond the cell's farthest one lies in the box.
  const Aabb around = bodies.widened(of.cell.box(), enough + less + 2 * rounding);
  PatchList listed;
  if (of.near == nullptr) listed = bodies.patches_near(other, around, budget, nullptr);
  const PatchList& near = of.near == nullptr ? listed : *of.near;
  BoxCorners corners(bodies, other, around, budget);
  double bound = -less;
  for (const std::uint32_t number : of.met) {
    budget.spend(kPlaneWork);
    const Patch& patch = bodies.patch(of.body, number);
    if (norm_squared(patch.normal) == 0) continue;
    const auto wall = wall_of(bodies.patches(of.body), patch, of.hollow, rounding);
    if (!wall) return INFINITY;
    if (of.cell.along(wall->normal).high + of.cell.error <= wall->height) continue;
    const double most = wall->height + enough + less - 2 * rounding;
    const double height = bodies.farthest(other, around, wall->normal, near, wall->height, most, budget) + rounding;
    if (height > most || !corners.is_free_beyond({wall->normal, height})) return INFINITY;
    bound = larger(bound, height - wall->height - less + rounding);
  }
  return bound;
}

}  // namespace satcheck
