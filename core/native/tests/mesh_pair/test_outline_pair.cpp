// Relations of prisms: heights, evidence, surfaces without an outline.
#include "mesh_pair/outline_pair.hpp"

#include "mesh_pair/moved_surface.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

// The square from (x, y), as a prism.
Surface square(double x, double y, double size, double height) {
  Mesh mesh;
  for (const double z : {-height, height}) {
    for (const Vec2 p : {Vec2{x, y}, Vec2{x + size, y}, Vec2{x + size, y + size}, Vec2{x, y + size}}) mesh.vertices.push_back({p.x, p.y, z});
  }
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t n = (k + 1) % 4;
    mesh.triangles.push_back({k, n, n + 4});
    mesh.triangles.push_back({k, n + 4, k + 4});
  }
  return make_surface(mesh, true);
}

Relation relation(const Surface& a, const Surface& b) { return prism_relation(a, b).value().relation; }

void test_relations() {
  const Surface big = square(0, 0, 8, 30), low = square(2, 2, 4, 20), high = square(2, 2, 4, 40);
  CHECK(relation(big, low) == Relation::contains && relation(low, big) == Relation::inside);
  CHECK(relation(big, high) == Relation::penetrating && relation(high, big) == Relation::penetrating);
  CHECK(relation(big, square(8, 1, 8, 20)) == Relation::touching);
  CHECK(relation(big, square(8 + 0x1p-49, 1, 8, 20)) == Relation::separated);
  CHECK(relation(big, square(8 - 0x1p-50, 1, 8, 20)) == Relation::penetrating);
  // A common wall, and the rest of the smaller one inside.
  const MeshRelation beside = prism_relation(big, square(4, 2, 4, 20)).value();
  CHECK(beside.relation == Relation::penetrating && beside.point && winding_number(big, *beside.point).value_or(1) != 0);
}

void test_other_pairs_are_left_to_the_meshes() {
  const Surface a = square(0, 0, 8, 30), b = square(4, 4, 8, 40);
  CHECK(!prism_relation(a, square(4, 4, 8, 30)));
  MovedSurface moved(a);
  CHECK(!prism_relation(moved.at({1, 0, 0}), b) && prism_relation(a, b));
}

}  // namespace

UNIT(outline_pair) {
  test_relations();
  test_other_pairs_are_left_to_the_meshes();
}
