// Two solids as the search for the thickness of their overlap sees them: flat convex patches, distances, insides.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "thickness/convex_patches.hpp"
#include "thickness/thickness_search.hpp"

namespace satcheck {

// From so many patches on, the tree of the surface has the ones in a place sooner than a list.
inline constexpr std::size_t kManyPatches = 1024;

// Measured steps: of a distance, and of a patch that is held against a box.
inline constexpr std::uint64_t kDistanceWork = 25, kFilterWork = 4;

using PatchList = std::vector<std::uint32_t>;
using PatchLists = std::array<PatchList, 2>;  // of either body

// A convex function that is no smaller than the depth of p in the body, for p of some region inside the body. Either the
// distance from a patch; or the distance from its plane, where the body does not reach beyond that plane near the region.
struct Column {
  std::uint32_t patch;
  bool plane;
  int body;
  double height;  // normal . p <= height holds for the body near the region
  double sign;    // the plane's normal is that of the patch, times this
};

// What two boxes that meet have in common.
inline Aabb common_box(const Aabb& a, const Aabb& b) {
  return {{std::fmax(a.min.x, b.min.x), std::fmax(a.min.y, b.min.y), std::fmax(a.min.z, b.min.z)},
          {std::fmin(a.max.x, b.max.x), std::fmin(a.max.y, b.max.y), std::fmin(a.max.z, b.max.z)}};
}

class TwoBodies {
 public:
  TwoBodies(const Surface& a, const Surface& b, const ThicknessGoal& goal);

  // What is computed in float64 about points of the bodies is off by less.
  double rounding() const { return rounding_; }
  bool in_plane() const { return across_ >= 0; }
  double scale() const { return scale_; }
  double less(int body) const { return less_[static_cast<std::size_t>(body)]; }
  const Surface& surface(int body) const { return *surfaces_[static_cast<std::size_t>(body)]; }
  const ConvexPatches& patches(int body) const { return patches_[static_cast<std::size_t>(body)]; }
  // All that is no farther from the box than that; in the plane, in its directions.
  Aabb widened(const Aabb& box, double reach) const;
  Aabb box(int body, std::uint32_t i) const { return patches(body).box(i); }
  const Patch& patch(int body, std::uint32_t i) const { return patches(body).patches[i]; }

  // Makes the patches of the triangles that are no farther than `reach` from the box. flatness: convex_patches.hpp. The time
  // is linear and no part of a search, which is as narrow for large meshes.
  void make_patches(const Aabb& box, double reach, double flatness);

  // Of the patches that were made, those with a triangle whose box meets this one: of the first `most` such triangles.
  PatchList patches_at(int body, const Aabb& box, Budget& budget, std::size_t most = kNoIndex) const;

  // Those whose box meets this one; where they are many, any kManyPatches of them or more, because the tree is asked
  // instead, but in a plane. known: of a box around this one; null: none.
  PatchList patches_near(int body, const Aabb& box, Budget& budget, const PatchList* known) const;
  bool may_be_part(const PatchList& near) const { return near.size() >= kManyPatches && !in_plane(); }

  // With less() of the body taken off.
  double value(const Column& column, Vec3 p) const;

  // Winding numbers, exact. Neither holds on the surface.
  bool is_inside(int body, Vec3 p, Budget& budget) const;
  bool is_outside(int body, Vec3 p, Budget& budget) const;

  // The distance from p to the nearest triangle of the body, from below.
  double clearance(int body, Vec3 p, Budget& budget) const;

  // The largest normal . x of the body's points in the box, or `least`: whichever is larger, rounding not included.
  // Anything above `enough` where it is larger than that. near: the patches of the body that meet the box, and others.
  double farthest(int body, const Aabb& box, Vec3 normal, const PatchList& near, double least, double enough,
                  Budget& budget) const;

  // The patch's plane as a column, where the body, of which `near` are the patches, has nothing beyond it in the box.
  // tolerance: by how much it may reach beyond the patch's own plane.
  std::optional<Column> plane_column(int body, std::uint32_t patch, const Aabb& box, const PatchList& near, double tolerance,
                                     Budget& budget) const;

 private:
  bool counts(int body, std::uint32_t triangle) const;
  double farthest_in_tree(int body, const Aabb& box, Vec3 normal, double least, double enough, Budget& budget) const;

  std::array<const Surface*, 2> surfaces_;
  std::array<double, 2> less_;
  std::array<ConvexPatches, 2> patches_;
  int across_;
  double scale_ = 0, rounding_ = 0;
};

}  // namespace satcheck
