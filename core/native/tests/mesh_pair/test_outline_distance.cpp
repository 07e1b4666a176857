// Distances of prisms: walls, ends, limits.
#include "mesh_pair/outline_pair.hpp"

#include "tests/check.hpp"
#include "tests/mesh/prisms.hpp"

using namespace satcheck;
using namespace satcheck::testing;

UNIT(outline_distance) {
  const Surface a = square_prism(0, 0, 8, 30), b = square_prism(11, 12, 2, 40);
  const MeshDistance corners = prism_distance(a, b, INFINITY).value();
  CHECK(corners.distance == 5 && corners.witness_a == (Vec3{8, 8, 0}) && corners.witness_b == (Vec3{11, 12, 0}));
  CHECK(prism_distance(a, b, 5).value().distance == 5 && prism_distance(a, b, 4.75).value().distance == INFINITY);
  CHECK(prism_distance(a, square_prism(8, 1, 2, 40), INFINITY).value().distance == 0);
  CHECK(!prism_distance(a, square_prism(7, 1, 2, 40), INFINITY));   // they cross
  CHECK(!prism_distance(a, square_prism(11, 1, 2, 31), INFINITY));  // the ends are 1 apart
  CHECK(prism_distance(a, square_prism(2, 3, 2, 40), INFINITY).value().distance == 2);  // inside
}
