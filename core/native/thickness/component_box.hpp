// A close box around a component of an overlap.
#pragma once

#include "overlap/overlap_components.hpp"
#include "thickness/thickness_search.hpp"

namespace satcheck {

// It holds the component, rounding included. The first axis is across the thinnest slab that holds it, so that a sliver
// between two facets has a box as flat as itself.
BoxAlong box_around(const OverlapComponent& component);

}  // namespace satcheck
