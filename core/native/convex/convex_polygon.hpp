// Convex polygons in a plane, many in one array of corners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

// A view of one polygon of a set.
struct ConvexPolygon {
  const Vec2* corners;  // counter-clockwise
  const Vec2* normals;  // [i]: unit, outward, of the edge from corner i to the next one
  std::uint32_t count;
  std::uint32_t lowest;   // the corner with the least y; of two, the one with the least x
  std::uint32_t highest;  // with the largest y; of two, the one with the largest x
  Vec2 low, high;         // the box around the corners

  std::uint32_t next(std::uint32_t i) const { return i + 1 == count ? 0 : i + 1; }
};

class ConvexPolygons {
 public:
  // Polygon k has the corners starts[k], ..., starts[k + 1] - 1: at least 3, counter-clockwise, no two successive ones
  // equal, not all on one line. Corners on straight edges are fine. Throws std::invalid_argument for other polygons and
  // for starts that do not fit, std::overflow_error for coordinates out of range (base/numeric_range.hpp).
  ConvexPolygons(std::vector<Vec2> corners, const std::vector<std::uint32_t>& starts);
  ConvexPolygons(const ConvexPolygons&) = delete;  // the views point into the arrays
  ConvexPolygons(ConvexPolygons&&) = default;

  std::size_t size() const { return polygons_.size(); }
  const ConvexPolygon& operator[](std::size_t k) const { return polygons_[k]; }

 private:
  std::vector<Vec2> corners_, normals_;
  std::vector<ConvexPolygon> polygons_;
};

// Each component of a normal is off by at most this share of itself: a difference, the two of the length, its root, a
// quotient.
inline constexpr double kEdgeNormalRoundoffs = 4;

// The length of the edge from p to q times `scale`, which is a power of two. Differences of subnormal numbers keep their
// digits.
struct EdgeLength {
  double scaled, scale;
};
EdgeLength edge_length(Vec2 p, Vec2 q);

}  // namespace satcheck
