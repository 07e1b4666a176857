// The touch band: is there a translation of A, no longer than the tolerance, after which A is free of B?
//
// First the way out of the hulls is tried. Then A is nudged off the triangles it crosses, along their normals and
// a third of the band at a time, so that a part in a corner can leave three walls. A part that was set flush into
// another crosses it by the rounding of its file, however deep it sits in the hull of the other.
#pragma once

#include <optional>

#include "mesh_pair/contact.hpp"
#include "scene/geometry.hpp"

namespace satcheck {

// within, deeper: proven. hidden: a translation as long as the tolerance frees A, and rounding hides whether one within
// it does. open: nothing was found.
enum class BandSide : std::uint8_t { open, within, deeper, hidden };

// move: of A, world; within it by the hulls alone there may be none. deepest: a proven lower bound of the depth, by the
// triangles that were found in the way.
struct WayWithin {
  std::optional<Vec3> move;
  double deepest = 0;
  BandSide side = BandSide::open;
};

// For bodies that overlap. crossing: triangles that meet; nothing where none are known: A is then not nudged. Ends
// early where a depth beyond the tolerance is proven.
WayWithin find_way_within(PlacedGeometry& a, PlacedGeometry& b, double tolerance, std::optional<ContactPair> crossing);

}  // namespace satcheck
