// Sample points for the pieces into which segments cut a triangle.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "exact_point.hpp"

namespace satcheck {

struct PlaneSegment {
  Vec3 p, q;  // distinct, in the plane of the triangle
};

// Gives exact points strictly inside one piece and on no segment: a different one for each attempt
// 0, 1, 2, ...
using PieceSampler = std::function<ExactPoint(int attempt)>;

// Calls visit(sampler) -> bool at least once for every piece, until it returns false. Returns
// whether all were visited.
//
// Every piece borders on a piece of a segment or of a triangle edge between two neighbouring
// intersections. From the middle of each such piece a ray into the triangle is followed part of the
// way to the first segment it meets: that point is inside the piece.
bool visit_pieces(const std::array<Vec3, 3>& triangle, const std::vector<PlaneSegment>& cuts,
                  const std::function<bool(const PieceSampler&)>& visit);

}  // namespace satcheck
