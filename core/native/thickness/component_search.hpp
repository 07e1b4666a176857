// The thickness of an overlap from its components: slivers between facets, one by one. The largest ball in the hull of
// each bounds it without a search.
#pragma once

#include <cstdint>
#include <functional>
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

class ComponentSearch {
 public:
  // known: an interval of the whole overlap, told as the progress meanwhile.
  ComponentSearch(const Surface& a, const Surface& b, const ThicknessGoal& goal, const ThicknessInterval& known);

  // False: the components say nothing.
  bool resolved() const { return overlap_.resolved; }

  // known: an interval of the whole overlap, narrowed by the balls in the hulls of the components. No search.
  ThicknessInterval bound(const ThicknessInterval& known);

  // Whether many hulls are much thicker than what is known: each of these components takes as long as the whole overlap.
  bool are_thick(const ThicknessInterval& known) const;

  // `within` is called for components whose hulls leave the goal open, the thickest hull first, with their boxes and their
  // share of the work that is left.
  using SearchWithin = std::function<ThicknessInterval(const ThicknessGoal&)>;
  ThicknessInterval search(const ThicknessInterval& known, const SearchWithin& within);

 private:
  double enough() const;
  void take_ball(const ThicknessInterval& ball);
  void take_point(const ThicknessInterval& other);
  template <class Share>
  void narrow(const SearchWithin& within, Share share);
  double upper_end(std::size_t component, const SearchWithin& within);
  ThicknessInterval searched(ThicknessGoal& goal, const SearchWithin& within);

  const ThicknessGoal& goal_;
  Budget budget_;
  OverlapComponents overlap_;
  std::vector<ThicknessInterval> balls_;
  ThicknessInterval best_;
  std::vector<double> upper_;  // of each component
  std::uint64_t share_ = 0;    // of the work that is left, for one component
};

}  // namespace satcheck
