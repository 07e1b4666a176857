#include "convex/few_edges.hpp"

#include <cmath>

#include "base/rounding.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// The least height of the corners of `other` above edge i.
double least_height(const ConvexPolygon& owner, std::uint32_t i, const ConvexPolygon& other) {
  const Vec2 from = owner.corners[i], normal = owner.normals[i];
  double even = INFINITY, odd = INFINITY;  // two chains of comparisons run at once
  for (std::uint32_t k = 0; k + 1 < other.count; k += 2) {
    even = smaller(dot(normal, other.corners[k] - from), even);
    odd = smaller(dot(normal, other.corners[k + 1] - from), odd);
  }
  return smaller(smaller(dot(normal, other.corners[other.count - 1] - from), even), odd);
}

std::uint32_t nearest_corner(const ConvexPolygon& owner, std::uint32_t i, const ConvexPolygon& other) {
  std::uint32_t nearest = 0;
  double least = INFINITY;
  for (std::uint32_t k = 0; k < other.count; ++k) {
    const double height = dot(owner.normals[i], other.corners[k] - owner.corners[i]);
    if (height < least) nearest = k, least = height;
  }
  return nearest;
}

// The error of the heights, as in gap_of(): the difference of two corners is not longer than the box of both polygons.
double height_error(const ConvexPolygon& a, const ConvexPolygon& b) {
  const double width = larger(a.high.x, b.high.x) - smaller(a.low.x, b.low.x);
  const double height = larger(a.high.y, b.high.y) - smaller(a.low.y, b.low.y);
  return (kEdgeNormalRoundoffs + 5) * kUnitRoundoff * (width + height) + kUnderflow;
}

}  // namespace

WidestEdge widest_of_few(const ConvexPolygon& a, const ConvexPolygon& b) {
  WidestEdge widest{-INFINITY, height_error(a, b), 0, 0, true};
  for (const bool of_a : {true, false}) {
    const ConvexPolygon &owner = of_a ? a : b, &other = of_a ? b : a;
    for (std::uint32_t i = 0; i < owner.count; ++i) {
      const double gap = least_height(owner, i, other);
      if (gap > widest.gap) widest.gap = gap, widest.edge = i, widest.of_a = of_a;
    }
  }
  widest.corner = widest.of_a ? nearest_corner(a, widest.edge, b) : nearest_corner(b, widest.edge, a);
  return widest;
}

}  // namespace satcheck
