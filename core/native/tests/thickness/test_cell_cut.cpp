// A cell over one face of a box: its distance bends beyond two edges of the face.
#include "thickness/cell_cut.hpp"

#include <cmath>

#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;

namespace {

// The patch of the side x = 0.
std::uint32_t left_patch(const TwoBodies& bodies) {
  std::uint32_t i = 0;
  while (!(bodies.patch(0, i).normal == Vec3{-1, 0, 0})) ++i;
  return i;
}

}  // namespace

UNIT(cell_cut) {
  const Surface a = make_surface(testing::box({0, 0, 0}, {1, 1, 1}), true), b = make_surface(testing::box({0, 0, 0}, {1, 2, 1}), true);
  TwoBodies bodies(a, b, {});
  Budget budget;
  bodies.make_patches({{0, 0, 0}, {1, 2, 1}}, 2, 1e-9);
  const Mat3 axes{};
  // The distance is exact in the lower half, y < 1, and bends where the face ends.
  const Cell cell = make_cell(axes, {0.25, 0, 0.25}, {0.5, 2, 0.75}, -1, 2);
  const std::vector<double> shares(8, 1.0 / 8);
  const CellGap gap{bodies, axes, cell, {{{left_patch(bodies), false, 0, 0, 1}, 1}}, shares, {0.375, 1, 0.5}, budget};
  const auto cut = cut_at_gap(gap, 0);
  CHECK(cut && std::fabs(cut->normal.y) == 1 && std::fabs(cut->height * cut->normal.y - 1) < 1e-12);
  // Half of the corners lie 1 beyond the face. The mean of their distances is 0.72, the distance at the middle 0.375.
  CHECK(cut_at_gap(gap, 0.3) && !cut_at_gap(gap, 0.4));
}
