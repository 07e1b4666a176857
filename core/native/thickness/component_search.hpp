// The thickness of an overlap from its components: slivers between facets, one by one.
#pragma once

#include <functional>
#include <optional>

#include "thickness/thickness_search.hpp"

namespace satcheck {

using SearchWithin = std::function<ThicknessInterval(const ThicknessGoal&)>;

// The hull of a component bounds its thickness at once. `search` is called for components whose hulls leave the goal open,
// the thickest hull first, with their boxes and their share of the work. known: an interval of the whole overlap.
// Nothing where the components are not resolved, or where many hulls are much thicker than what is known: each of
// these components takes as long as the whole overlap took.
std::optional<ThicknessInterval> search_components(const Surface& a, const Surface& b, const ThicknessGoal& goal,
                                                   const ThicknessInterval& known, const SearchWithin& search);

}  // namespace satcheck
