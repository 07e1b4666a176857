// Bodies that fit: in a small region all triangles of both lie in a few strips, each as thick as the rounding of the files.
//
// A strip is the space between two parallel planes. Outside of all strips nothing of a surface is left, so that a sector,
// the region on given sides of all strips, is inside or outside of a body as one of its points is. A point in a strip
// is no deeper in a body than it is far from a sector outside of that body.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/budget.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

// The part of a triangle in a region, as points of the triangle.
struct StripPiece {
  int body;
  std::uint32_t triangle;
  std::vector<std::array<double, 3>> shares;  // of its corners, by point
};

// low <= axis . p <= high for each axis.
struct StripRegion {
  Mat3 axes;
  std::array<double, 3> low, high;
};

// The pieces of the triangles that meet the region. scale: no coordinate is larger.
StripPiece clipped(const Surface& surface, int body, std::uint32_t triangle, const StripRegion& region, double scale);

enum class StripAnswer : std::uint8_t {
  thin,    // no point of the region is deeper than `half` in both bodies
  deeper,  // a point is
  divide,  // the region has to be divided
};

struct StripCut {
  int axis;
  double at;
};

struct StripResult {
  StripAnswer answer = StripAnswer::divide;
  std::optional<StripCut> cut = {};  // between parallel faces; nothing: anywhere
  // thin: whether each body with a strip has a sector that is inside, unless nothing in the region is in both. No body is
  // then as thin there as the strips, as a sheet between two parallel faces of one strip is.
  bool thick_bodies = true;
};

// region: extends beyond the points that are asked for by more than `half`. pieces: all that meet it.
StripResult judge_strips(const Surface& a, const Surface& b, const StripRegion& region,
                         const std::vector<StripPiece>& pieces, double half, double scale, Budget& budget);

}  // namespace satcheck
