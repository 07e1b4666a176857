// The connected components of the overlap of two solids.
//
// Both surfaces cut space into cells (space_cells.hpp). The cells that lie in both solids are the overlap. Cells
// separated only by a face inside one of the solids are joined. Exact predicates decide everything; what they leave
// open is not resolved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/surface.hpp"

namespace satcheck {

struct OverlapComponent {
  Aabb bounds;
  Vec3 point;  // of its boundary; rounded
  std::vector<Vec3> corners;  // of the faces of its boundary, rounded; may contain duplicates
  std::size_t triangles = 0;  // that bound it
  std::size_t curves = 0;     // curves along which the surfaces cross there; where curves meet, each ends
  double curve_length = 0;
  double volume = 0;  // in float64; volume_error: its approximate error
  double volume_error = 0;
  // Whether a connected piece of A's surface within B joins two pieces of B's surface within A, as a pin through a
  // plate joins the places where it enters and leaves. Empty: it depends on coincident faces, or is not resolved.
  std::optional<bool> a_through_b, b_through_a;
  bool resolved = true;  // false: a surface meets itself here, and this may be several components, or a part of one
};

struct OverlapComponents {
  // False: the number of components may differ, because a surface meets itself within the other body or is not closed,
  // or because `within_limits` is false.
  bool resolved = true;
  bool within_limits = true;  // false: too many triangles meet, or it takes more steps than it may; nothing is listed
  std::vector<OverlapComponent> components;  // by the least corner of their bounds
};

// What is returned of an overlap that is not resolved: its components as far as they are known, or none, which is faster.
enum class Unresolved : std::uint8_t { described, left_out };

// Swapping a and b only swaps the fields of a and b. max_pairs: limit on pairs of triangles that meet; more are not
// resolved. budget: that stops, see budget_of_pair().
OverlapComponents overlap_components(const Surface& a, const Surface& b, std::size_t max_pairs,
                                     Unresolved unresolved = Unresolved::described, Budget* budget = nullptr);

// Whether one of two solids passes through the other, whichever body coincident faces belong to. Empty: not resolved.
std::optional<bool> passes_through(const Surface& a, const Surface& b, std::size_t max_pairs, Budget* budget = nullptr);

}  // namespace satcheck
