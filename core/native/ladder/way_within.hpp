// The touch band: searches a translation of A, no longer than the tolerance, after which A is free of B.
//
// First the way out of the hulls is tried. Then A is moved away from the triangles that it crosses, along their
// normals, by a third of the band at a time, so that a part in a corner can leave three walls. A part that is flush in
// a pocket of another one is deep in its hull, but crosses its surface only by the rounding of the files.
#pragma once

#include <optional>

#include "mesh_pair/contact.hpp"
#include "ladder/geometry.hpp"

namespace satcheck {

// within, deeper: proven. hidden: a translation as long as the tolerance frees A, but rounding hides whether one within
// the tolerance does. open: nothing was found.
enum class BandSide : std::uint8_t { open, within, deeper, hidden };

// move: a translation of A, world; may be empty if only the hulls prove `within`. deepest: a proven lower bound of the
// depth, by the triangles that were met.
struct WayWithin {
  std::optional<Vec3> move;
  double deepest = 0;
  BandSide side = BandSide::open;
};

// For bodies that overlap. crossing: triangles that meet; empty: none are known, and only the hulls are tried. Ends
// early if a depth beyond the tolerance is proven, or if the budget, which stops, is spent.
WayWithin find_way_within(PlacedGeometry& a, PlacedGeometry& b, double tolerance, std::optional<ContactPair> crossing,
                          Budget& budget);

}  // namespace satcheck
