// A convex set of translations of A, each of which leaves A and B with a common interior.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/budget.hpp"
#include "base/vec.hpp"
#include "depth/inner_region.hpp"

namespace satcheck {

using RegionPair = std::pair<InnerRegion, InnerRegion>;  // in A, in B

// The Minkowski difference B' - A' of two convex bodies: A' inside A, B' inside B. A translation on the inner side of
// all planes is proven to be in its interior, because the planes are moved inward from the facets by the rounding
// error.
struct ForbiddenSet {
  std::vector<Vec3> normal;  // unit, outward
  std::vector<double> offset;
  std::vector<double> facet;  // the offset of the facet itself, rounded to nearest
  Aabb box;
  std::uint32_t number = 0;  // in a union of such sets

  bool empty() const { return normal.empty(); }

  // The shortest way to the planes. Its depth is positive inside; it is then also the radius of a ball of forbidden
  // translations about t.
  struct Exit {
    double depth = 0;
    Vec3 normal;
  };
  Exit exit(Vec3 t) const;
  bool holds(Vec3 t) const;  // whether that depth is positive

  // length: the set contains all translations in the box that are shorter than this, because planes at least this far
  // from the origin cut off only longer ones. Infinite if the set contains the whole box, -infinite if they do not
  // meet. facets: the number of those that the box reaches.
  struct Reach {
    double length;
    bool meets;
    std::size_t facets = 0;
  };
  Reach reach(Vec3 centre, Vec3 half) const;

  // The same set without the facets that the box does not reach: within the box, they are the same.
  ForbiddenSet within(Vec3 centre, Vec3 half) const;

  // The same length for the part of the box beyond a plane: normal . t >= offset, `normal` unit. If it is less than
  // `least`, any number below `least`.
  double reach_beyond(Vec3 centre, Vec3 half, Vec3 normal, double offset, double least,
                      Budget& budget) const;
};

// The forbidden set of two convex hulls of points; empty if the difference has no volume.
ForbiddenSet forbidden_set(const std::vector<Vec3>& part_of_a, const std::vector<Vec3>& part_of_b,
                           Budget* budget = nullptr);

}  // namespace satcheck
