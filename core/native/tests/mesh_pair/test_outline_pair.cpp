// Relations of prisms: heights, evidence, surfaces without an outline.
#include "mesh_pair/outline_pair.hpp"

#include "mesh_pair/moved_surface.hpp"
#include "tests/check.hpp"
#include "tests/mesh/prisms.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

Relation relation(const Surface& a, const Surface& b) { return prism_relation(a, b).value().relation; }

void test_relations() {
  const Surface big = square_prism(0, 0, 8, 30), low = square_prism(2, 2, 4, 20), high = square_prism(2, 2, 4, 40);
  CHECK(relation(big, low) == Relation::contains && relation(low, big) == Relation::inside);
  CHECK(relation(big, high) == Relation::penetrating && relation(high, big) == Relation::penetrating);
  CHECK(relation(big, square_prism(8, 1, 8, 20)) == Relation::touching);
  CHECK(relation(big, square_prism(8 + 0x1p-49, 1, 8, 20)) == Relation::separated);
  CHECK(relation(big, square_prism(8 - 0x1p-50, 1, 8, 20)) == Relation::penetrating);
  // A common wall, and the rest of the smaller one inside.
  const MeshRelation beside = prism_relation(big, square_prism(4, 2, 4, 20)).value();
  CHECK(beside.relation == Relation::penetrating && beside.point && winding_number(big, *beside.point).value_or(1) != 0);
}

void test_other_pairs_are_left_to_the_meshes() {
  const Surface a = square_prism(0, 0, 8, 30), b = square_prism(4, 4, 8, 40);
  CHECK(!prism_relation(a, square_prism(4, 4, 8, 30)));
  MovedSurface moved(a);
  CHECK(!prism_relation(moved.at({1, 0, 0}), b) && prism_relation(a, b));
}

}  // namespace

UNIT(outline_pair) {
  test_relations();
  test_other_pairs_are_left_to_the_meshes();
}
