// The thickness of the components of an overlap without a search, and close boxes around them.
#pragma once

#include <vector>

#include "overlap/overlap_components.hpp"
#include "thickness/thickness_search.hpp"

namespace satcheck {

// The hull of more points is no sliver, and is not looked at.
inline constexpr std::size_t kMostHullPoints = 5000;

// Of each component. upper: the diameter of the largest ball in its convex hull, which is its thickness where it is
// convex, as slivers between facets are; of components with many corners, that in their box. centre: of that ball; lower: how thick the overlap of the solids is around it,
// and 0 where it does not lie in both, or may belong to another component.
std::vector<ThicknessInterval> component_balls(const Surface& a, const Surface& b, const OverlapComponents& overlap);

// A close box around a component, which holds it, rounding included. The first axis is across the thinnest slab that holds
// it, so that a sliver between two facets has a box as flat as itself.
BoxAlong box_around(const OverlapComponent& component);

}  // namespace satcheck
