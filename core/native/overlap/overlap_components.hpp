// The connected components of what two solids have in common.
//
// Of the cells into which both surfaces cut space (space_cells.hpp), those that lie in both solids, joined where only
// a face within one of them parts them. All is decided by exact predicates: what they leave open is not resolved.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mesh/surface.hpp"

namespace satcheck {

struct OverlapComponent {
  Aabb bounds;
  Vec3 point;  // of its boundary; rounded
  std::vector<Vec3> corners;  // of the faces of its boundary, rounded; some more than once
  std::size_t triangles = 0;  // that take part in its boundary
  std::size_t curves = 0;     // along which the surfaces cross there; where curves meet, each ends
  double curve_length = 0;
  double volume = 0;  // in float64; volume_error: about how far off that is
  double volume_error = 0;
  // Does a connected piece of A's surface within B join two pieces of B's surface within A, as a pin through a plate
  // joins the places where it enters and leaves? Nothing: that depends on faces that lie in each other, or is not
  // resolved.
  std::optional<bool> a_through_b, b_through_a;
  bool resolved = true;  // false: a surface meets itself here, and this may be several components, or a part of one
};

struct OverlapComponents {
  // Where false there may be others, or fewer: a surface meets itself within the other body, or is not closed, or too
  // much meets.
  bool resolved = true;
  std::vector<OverlapComponent> components;  // by the least corner of their bounds
};

// Swapping a and b changes the letters, nothing else. max_pairs: of triangles that meet; more are not resolved.
OverlapComponents overlap_components(const Surface& a, const Surface& b, std::size_t max_pairs);

// Does one of two solids pass through the other? Nothing: not resolved.
std::optional<bool> passes_through(const Surface& a, const Surface& b, std::size_t max_pairs);

}  // namespace satcheck
