// A convex cell of space: an intersection of half spaces, with its corners.
#pragma once

#include <optional>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

// Of heights along a direction.
struct Range {
  double low = INFINITY, high = -INFINITY;

  void include(double height) {
    low = smaller(low, height);
    high = larger(high, height);
  }
  bool empty() const { return low > high; }
  double width() const { return high - low; }
  double middle() const { return (low + high) / 2; }
};

// normal . p <= height, |normal| = 1 up to rounding.
struct HalfSpace {
  Vec3 normal;
  double height;
};

// Exactly the intersection of its half spaces, in general position: each corner lies on three planes, and an edge joins
// two corners that share two. A flat cell lies in its first plane.
struct Cell {
  struct Corner {
    Vec3 at;               // rounded
    std::uint64_t planes;  // bit i: on the plane of sides[i]
  };
  std::vector<HalfSpace> sides;
  std::vector<Corner> corners;
  double error = 0;  // no corner is farther than this from its exact place

  Aabb box() const;
  Range along(Vec3 direction) const;
};

// A frame of three axes, perpendicular up to rounding, with an interval along each. scale: no coordinate is larger.
// flat: an axis along which the interval is one point, or -1.
Cell make_cell(const Mat3& axes, Vec3 low, Vec3 high, int flat, double scale);

struct Halves {
  Cell below, above;  // normal . p <= height, and >= height
  HalfSpace plane;
};

// The two parts of a cell. No new corner is off by more than `error`: the height differs from the given one where a
// corner is too close to the plane, or an edge almost in it. Nothing where one part is empty, or no such height is near.
std::optional<Halves> split(const Cell& cell, const HalfSpace& plane, double scale, double error);

}  // namespace satcheck
