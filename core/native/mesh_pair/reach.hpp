// Whether a surface reaches deeper into a solid than a length.
#pragma once

#include <cstdint>
#include <optional>

#include "base/mesh.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/nearest_point.hpp"

namespace satcheck {

// A piece of a triangle beside a solid: its centre, the radius around that, the point of the solid's surface nearest to
// the centre, and a bound of the distance from any point of the piece to the triangle of that point, which is convex.
struct NearPiece {
  NearPiece(const Surface& solid, const Corners& piece, Budget* budget);

  Vec3 centre;
  double radius = 0;
  NearestPoint nearest;
  double to_triangle = 0;
};

// The halves of a piece, across its longest side.
std::array<Corners, 2> halves(const Corners& piece);

// Whether a point of the triangles of `surface_of` lies inside the solid, farther than `length` from all triangles of it,
// to rounding. Nothing where `work` steps (base/budget.hpp) do not decide that.
std::optional<bool> reaches_deeper(const Mesh& surface_of, const Surface& solid, double length, std::uint64_t work);

}  // namespace satcheck
