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

  // The support corners of the directions at pseudo_angle() 4 k / sectors. sectors: a power of two, at least 4.
  const std::uint32_t* sector_starts;
  std::uint32_t sectors;

  std::uint32_t next(std::uint32_t i) const { return i + 1 == count ? 0 : i + 1; }
  std::uint32_t previous(std::uint32_t i) const { return (i == 0 ? count : i) - 1; }

  // The corner farthest along a direction that is not 0; kSupportRoundoffs says how far it may fall short.
  std::uint32_t support(Vec2 direction) const {
    return count <= kScanned ? scan(direction) : climb(sector_starts[sector_of(direction)], direction);
  }
  // From a corner that is at most half a turn short of it.
  std::uint32_t climb(std::uint32_t i, Vec2 direction) const {
    while (cross(normals[i], direction) > 0) i = next(i);
    return i;
  }

 private:
  // With fewer corners, a scan without branches is faster.
  static constexpr std::uint32_t kScanned = 8;

  std::uint32_t scan(Vec2 direction) const {
    std::uint32_t best = 0;
    double highest = 0;
    for (std::uint32_t i = 1; i < count; ++i) {
      const double height = dot(direction, corners[i] - corners[0]);
      best = height > highest ? i : best;
      highest = larger(height, highest);
    }
    return best;
  }
  std::uint32_t sector_of(Vec2 direction) const;
};

// Grows with the angle of the direction, from 0 at +x over 1 at +y to 4. The direction is not 0.
inline double pseudo_angle(Vec2 d) {
  const double slope = d.y / (std::fabs(d.x) + std::fabs(d.y));
  return d.x < 0 ? 2 - slope : d.y < 0 ? 4 + slope : slope;
}

inline std::uint32_t ConvexPolygon::sector_of(Vec2 direction) const {
  return static_cast<std::uint32_t>(pseudo_angle(direction) * (sectors / 4)) & (sectors - 1);
}

// The edges between a corner that support() returns and the farthest one leave the direction by at most this angle, in
// roundoffs: a normal 4 sqrt(2), a product 3, the angle 8, rounded up. So a support value falls short by at most that
// share of half the outline, which is at most the width and the height of the box.
inline constexpr double kSupportRoundoffs = 20;

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
  std::vector<std::uint32_t> sector_starts_;
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
