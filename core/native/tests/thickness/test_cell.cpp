// Parts of cells: their corners, and what a plane leaves of them.
#include "thickness/cell.hpp"

#include <cmath>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

constexpr double kError = 2e-13;

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
  const auto halves = split(cube, {{third, third, third}, third / 2}, 1, kError);
  CHECK(halves && halves->below.corners.size() == 4 && halves->below.sides.size() == 4);
  CHECK(halves && halves->above.corners.size() == 10 && halves->above.sides.size() == 7);
  for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{0.5, 0, 0}, Vec3{0, 0.5, 0}, Vec3{0, 0, 0.5}}) {
    CHECK(halves && has_corner(halves->below, p));
  }
  CHECK(halves && !has_corner(halves->above, {0, 0, 0}));

  // A plane through corners is shifted off them by no more than rounding, and one beyond the cell leaves one part.
  const auto wedges = split(cube, {{std::sqrt(0.5), std::sqrt(0.5), 0}, std::sqrt(0.5)}, 1, kError);
  CHECK(wedges && std::fabs(wedges->plane.height - std::sqrt(0.5)) < 1e-12);
  CHECK(!split(cube, {{1, 0, 0}, 1.5}, 1, kError));

  const Cell square = make_cell(Mat3{}, {0, 0, 0.25}, {1, 1, 0.25}, 2, 1);
  CHECK(square.corners.size() == 4);
  const auto triangles = split(square, {{std::sqrt(0.5), std::sqrt(0.5), 0}, std::sqrt(0.125)}, 1, kError);
  CHECK(triangles && triangles->below.corners.size() == 3 && triangles->above.corners.size() == 5);

  // A plane along an edge, almost: where it meets that edge is not known, so it passes by one end of it.
  const double slope = 1e-5;
  const auto slabs = split(cube, {Vec3{1, 0, slope} * (1 / std::sqrt(1 + slope * slope)), slope / 2}, 1, kError);
  CHECK(slabs && slabs->below.corners.size() == 8 && slabs->below.error <= kError);
  const auto rough = split(cube, {Vec3{1, 0, slope} * (1 / std::sqrt(1 + slope * slope)), slope / 2}, 1, 1e-9);
  CHECK(rough && std::fabs(rough->plane.height - slope / 2) < 1e-12);
}
