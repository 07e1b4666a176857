// A way out of the touch band: off one wall and out of a corner of three, none of what is deeper, none without a
// place to start from; and what is found has freed A.
#include "mesh/transform.hpp"
#include "ladder/way_within.hpp"

#include <cmath>

#include "base/rounding.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

constexpr double kBand = 1e-6, kSlip = 1e-9;

PlacedGeometry placed(const Mesh& mesh) {
  Aabb bounds;
  for (const Vec3& p : mesh.vertices) bounds.include(p);
  return {std::make_shared<Geometry>(std::make_shared<Mesh>(mesh), true), std::nullopt, bounds, 0.0};
}

Mesh cube() { return box({0, 0, 0}, {1, 1, 1}); }

// Boxes below the cube along the first axes, each reaching into it by `slip`, and one above: the hull holds the cube.
Mesh corner(int walls, double slip) {
  Mesh mesh = box({-1, -1, 3}, {4, 4, 4});
  append(mesh, box({-1, 0.25, 0.25}, {slip, 0.5, 0.5}));
  if (walls > 1) append(mesh, box({0.25, -1, 0.25}, {0.5, slip, 0.5}));
  if (walls > 2) append(mesh, box({0.25, 0.25, -1}, {0.5, 0.5, slip}));
  return mesh;
}

WayWithin way_out(PlacedGeometry& a, PlacedGeometry& b, double band) {
  const MeshRelation found = mesh_relation(*a.surface(), *b.surface());
  CHECK(found.relation == Relation::penetrating && found.triangle_b != kNoIndex);
  Budget budget = Budget::that_stops(kMostSteps);
  return find_way_within(a, b, band, ContactPair{found.triangle_a, found.triangle_b}, budget);
}

std::optional<Vec3> move_out_of_hulls(PlacedGeometry& a, PlacedGeometry& b) {
  Budget budget = Budget::that_stops(kMostSteps);
  return find_way_within(a, b, kBand, std::nullopt, budget).move;
}

void up_to_three_walls_are_left() {
  for (int walls = 1; walls <= 3; ++walls) {
    PlacedGeometry a = placed(cube()), b = placed(corner(walls, kSlip));
    const WayWithin found = way_out(a, b, kBand);
    CHECK(found.move && norm(*found.move) <= kBand && found.deepest <= kBand);
    CHECK(mesh_relation(make_surface(translate(cube(), *found.move), true), *b.surface()).relation == Relation::separated);
  }
}

void what_is_deeper_stays() {
  PlacedGeometry a = placed(cube()), b = placed(corner(3, 1e-3));
  const WayWithin found = way_out(a, b, kBand);
  CHECK(!found.move && found.side == BandSide::deeper && found.deepest > kBand && found.deepest <= 1e-3);
}

void without_a_crossing_only_the_hulls_are_left() {
  PlacedGeometry a = placed(cube()), b = placed(corner(1, kSlip)), beside = placed(box({1 - kSlip, 0, 0}, {2, 1, 1}));
  CHECK(!move_out_of_hulls(a, b));
  const std::optional<Vec3> move = move_out_of_hulls(a, beside);
  CHECK(move && std::fabs(move->x + kSlip) <= 2 * chain_rounding(2.0) && move->y == 0 && move->z == 0);
}

void a_spent_budget_leaves_the_band_open() {
  PlacedGeometry a = placed(cube()), b = placed(corner(1, kSlip));
  const MeshRelation crossing = mesh_relation(*a.surface(), *b.surface());
  Budget few = Budget::that_stops(1);
  const WayWithin found = find_way_within(a, b, kBand, ContactPair{crossing.triangle_a, crossing.triangle_b}, few);
  CHECK(!found.move && found.side == BandSide::open && few.is_spent());
}

}  // namespace

UNIT(way_within) {
  up_to_three_walls_are_left();
  what_is_deeper_stays();
  without_a_crossing_only_the_hulls_are_left();
  a_spent_budget_leaves_the_band_open();
}
