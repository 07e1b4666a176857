// The separating axis test of two polygons with few corners: every edge against every corner, without a walk. With few
// corners, this takes less time than GJK.
#pragma once

#include "convex/convex_polygon.hpp"

namespace satcheck {

inline constexpr std::uint32_t kFewCorners = 8;

inline bool have_few_corners(const ConvexPolygon& a, const ConvexPolygon& b) {
  return a.count <= kFewCorners && b.count <= kFewCorners;
}

// The edge of A or B that the other polygon is farthest outside of, and the corner that is nearest to it.
struct WidestEdge {
  double gap, error;  // |exact - gap| <= error. Every other edge has a gap of at most gap + error
  std::uint32_t edge, corner;
  bool of_a;
};

WidestEdge widest_of_few(const ConvexPolygon& a, const ConvexPolygon& b);

}  // namespace satcheck
