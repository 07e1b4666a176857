// The pieces into which segments cut a triangle, each with points inside it.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "exact/exact_point.hpp"

namespace satcheck {

struct PlaneSegment {
  ExactPoint p, q;  // distinct, in the plane of the triangle
};

struct Piece {
  // An exact point strictly inside the piece and on no segment, a different one for each attempt
  // 0, 1, 2, ..., and no three of them on a line unless the triangle is cut.
  std::function<ExactPoint(int attempt)> sample;
  // Two neighbouring corners of the piece, or all three corners of a triangle that is not cut.
  std::function<std::vector<ExactPoint>()> ends;
};

enum class Touching { left_out, kept };

// Calls visit(piece) -> bool at least once for every piece, until it returns false. Returns whether all
// were visited. With Touching::kept every point in which a segment meets the closed triangle is an end
// of each piece around it.
//
// Every piece borders on a stretch of a segment or of a triangle edge, between two neighbouring intersections. A line
// leads from the middle of each stretch into the triangle, up to the first segment it meets. A point on this line is
// inside the piece.
bool visit_pieces(const std::array<Vec3, 3>& triangle, const std::vector<PlaneSegment>& cuts,
                  Touching touching, const std::function<bool(const Piece&)>& visit, Budget* budget = nullptr);

}  // namespace satcheck
