// Parts of cells: their corners, and what a plane leaves of them.
#include "thickness/cell.hpp"

#include <cmath>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

bool has_corner(const Cell& cell, Vec3 p) {
  for (const Cell::Corner& corner : cell.corners) {
    if (norm(corner.at - p) <= cell.error + 1e-12) return true;
  }
  return false;
}

}  // namespace

UNIT(cell) {
  const Cell cube = make_cell(Mat3{}, {0, 0, 0}, {1, 1, 1}, -1, 1);
  CHECK(cube.corners.size() == 8 && cube.sides.size() == 6);

  // A corner is cut off: a tetrahedron, and the rest with seven sides.
  const double third = std::sqrt(1.0 / 3);
  const auto halves = split(cube, {{third, third, third}, third / 2}, 1);
  CHECK(halves && halves->below.corners.size() == 4 && halves->below.sides.size() == 4);
  CHECK(halves && halves->above.corners.size() == 10 && halves->above.sides.size() == 7);
  for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{0.5, 0, 0}, Vec3{0, 0.5, 0}, Vec3{0, 0, 0.5}}) {
    CHECK(halves && has_corner(halves->below, p));
  }
  CHECK(halves && !has_corner(halves->above, {0, 0, 0}));

  // A plane through corners is shifted off them by no more than rounding, and one beyond the cell leaves one part.
  const auto wedges = split(cube, {{std::sqrt(0.5), std::sqrt(0.5), 0}, std::sqrt(0.5)}, 1);
  CHECK(wedges && std::fabs(wedges->plane.height - std::sqrt(0.5)) < 1e-12);
  CHECK(!split(cube, {{1, 0, 0}, 1.5}, 1));

  const Cell square = make_cell(Mat3{}, {0, 0, 0.25}, {1, 1, 0.25}, 2, 1);
  CHECK(square.corners.size() == 4);
  const auto triangles = split(square, {{std::sqrt(0.5), std::sqrt(0.5), 0}, std::sqrt(0.125)}, 1);
  CHECK(triangles && triangles->below.corners.size() == 3 && triangles->above.corners.size() == 5);
}
