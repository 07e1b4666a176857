// The parts of solids of random cells: each is a solid with its caves, and together they are the cells.
#include "mesh/cavities.hpp"

#include "mesh/facing.hpp"
#include "mesh/orient.hpp"
#include "mesh/surface.hpp"
#include "mesh/topology.hpp"
#include "tests/boxes.hpp"
#include "tests/check.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

// Caves often touch the surface around them at a corner, where no edge is common. One mesh in two is inside out.
void caves_belong_to_their_solids() {
  std::mt19937 generator(6);
  std::size_t several = 0;
  for (int round = 0; round < rounds(200); ++round) {
    const Cells cells = random_cells(generator, 5, 0.15 + 0.2 * (round % 5));
    const Mesh outward = boundary_of(cells);
    const std::vector<Mesh> parts = split_components(round % 2 == 0 ? outward : reversed(outward));
    several += parts.size() > 1;
    std::vector<Surface> solids;
    for (const Mesh& part : parts) {
      Mesh oriented = orient(part);
      turn(oriented, facing_of(oriented).inward);
      solids.push_back(make_surface(oriented, true));
    }
    for (int x = 0; x < 5; ++x)
      for (int y = 0; y < 5; ++y)
        for (int z = 0; z < 5; ++z) {
          int sum = 0;
          for (const Surface& solid : solids) {
            const int winding = winding_number(solid, {x + 0.5, y + 0.5, z + 0.5}).value_or(-9);
            CHECK(winding == 0 || winding == 1);
            sum += winding;
          }
          CHECK(sum == (cells(x, y, z) ? 1 : 0));
        }
  }
  CHECK(several > 0);
}

// Two boxes that face outward, then two walls: the outer wall is that of the inner box, the inner one that of the outer.
void walls_are_matched_like_brackets() {
  const auto cube = [](double half) { return box({-half, -half, -half}, {half, half, half}); };
  Mesh nested = cube(8);
  append(nested, cube(6));
  append(nested, reversed(cube(4)));
  append(nested, reversed(cube(2)));
  const std::vector<Mesh> parts = split_components(nested);
  CHECK(parts.size() == 2);
  CHECK(measure_topology(parts[0]).volume == 16 * 16 * 16 - 4 * 4 * 4);
  CHECK(measure_topology(parts[1]).volume == 12 * 12 * 12 - 8 * 8 * 8);
}

}  // namespace

UNIT(cavities) {
  caves_belong_to_their_solids();
  walls_are_matched_like_brackets();
}
