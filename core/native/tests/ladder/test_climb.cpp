// Which rungs run for a pair and what they hand over; many at once answer as one by one, and a body that cannot be
// made takes its own pairs with it, and no others.
#include "mesh/transform.hpp"
#include "ladder/climb.hpp"

#include <cmath>
#include <stdexcept>

#include "mesh/inspection.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

Matrix shifted(double x, double y = 0, double z = 0, double angle = 0) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c, -s, 0, x, s, c, 0, y, 0, 0, 1, z, 0, 0, 0, 1};
}

// A box with a cavity.
Mesh hollow() {
  Mesh mesh = box({0, 0, 0}, {6, 6, 6});
  append(mesh, reversed(box({1, 1, 1}, {5, 5, 5})));
  return mesh;
}

Aabb bounds_of(const Mesh& mesh) {
  Aabb bounds;
  for (const Vec3& p : mesh.vertices) bounds.include(p);
  return bounds;
}

std::shared_ptr<Geometry> geometry(Mesh mesh, bool solid = true) {
  return std::make_shared<Geometry>(std::make_shared<Mesh>(std::move(mesh)), solid);
}

std::unique_ptr<PlacedGeometry> placed(const std::shared_ptr<Geometry>& shared, const Matrix& matrix) {
  return std::make_unique<PlacedGeometry>(shared, matrix, bounds_of(transform(*shared->mesh(), matrix)), 1e-9);
}

ClimbRequest asked(PlacedGeometry& a, PlacedGeometry& b, double gap = 1e-9) { return {&a, &b, gap, 1e-9, 5e-10, 5e-10, false}; }

void the_lowest_rung_that_settles_ends_it() {
  const auto bar = geometry(box({-5, -0.5, -0.5}, {5, 0.5, 0.5}));
  const auto a = placed(bar, shifted(0, 0, 0, 0.8)), far = placed(bar, shifted(30)), near = placed(bar, shifted(2, 0, 0, 0.8));
  const Climb by_boxes = climb(asked(*a, *far), Rung::aabb, Rung::triangles);
  CHECK(by_boxes.box_gap > 10 && by_boxes.boxes == BoxOutcome::not_asked && !by_boxes.hulls);
  const Climb by_oriented = climb(asked(*a, *near), Rung::aabb, Rung::triangles);
  CHECK(by_oriented.box_gap == 0 && by_oriented.boxes == BoxOutcome::apart && !by_oriented.hulls);
  CHECK(bar->known_convex() == std::nullopt && bar->hierarchies() == 0);
  const auto across = placed(bar, shifted(0.1, 0, 0, -0.8));
  const Climb by_hulls = climb(asked(*a, *across), Rung::aabb, Rung::triangles);
  CHECK(by_hulls.both_convex && by_hulls.hulls->outcome == Outcome::penetrating && by_hulls.hulls->has_distance);
  CHECK(!by_hulls.nesting && !by_hulls.triangles && bar->hierarchies() == 0);
}

void what_triangles_find() {
  const auto shell = geometry(hollow()), cube = geometry(box({0, 0, 0}, {1, 1, 1}));
  const auto outer = placed(shell, shifted(0)), loose = placed(cube, shifted(2, 2, 2)),
             stuck = placed(cube, shifted(5.5, 2, 2));
  const Climb free = climb(asked(*outer, *loose), Rung::aabb, Rung::triangles);
  CHECK(!free.both_convex && free.hulls->outcome != Outcome::separated);
  CHECK(free.triangles->relation == Relation::separated && std::isinf(free.gap->distance) && !free.least_depth);
  ClimbRequest measured = asked(*outer, *loose);
  measured.wants_distance = true;
  CHECK(climb(measured, Rung::aabb, Rung::triangles).gap->distance == 1);
  const Climb deep = climb(asked(*outer, *stuck), Rung::aabb, Rung::triangles);
  CHECK(deep.triangles->relation == Relation::penetrating && deep.thick && *deep.thick && !deep.least_depth && !deep.gap);
  const Climb capped = climb(asked(*outer, *stuck), Rung::aabb, Rung::hull);
  CHECK(capped.hulls && !capped.triangles && !capped.least_depth);
  CHECK(shell->hierarchies() == 1 && cube->hierarchies() == 1);
}

void many_answer_as_one_by_one() {
  const auto shell = geometry(hollow()), open = geometry(Mesh{{{0, 0, 0}, {9, 0, 0}, {0, 9, 1}}, {{0, 1, 2}}}, true);
  std::vector<std::unique_ptr<PlacedGeometry>> bodies;
  for (int k = 0; k < 40; ++k) bodies.push_back(placed(k == 20 ? open : shell, shifted(5.2 * k, 0.1 * k, 0, 0.3 * k)));
  std::vector<ClimbRequest> requests;
  for (std::size_t k = 0; k + 1 < bodies.size(); ++k) requests.push_back(asked(*bodies[k], *bodies[k + 1]));
  const auto one = climb_all(requests, Rung::triangles, 1), many = climb_all(requests, Rung::triangles, 4);
  for (std::size_t k = 0; k < requests.size(); ++k) {
    CHECK(one[k].has_value() == many[k].has_value());
    if (!one[k] || !many[k]) continue;
    CHECK(one[k]->box_gap == many[k]->box_gap && one[k]->least_depth == many[k]->least_depth);
    CHECK(one[k]->triangles.has_value() == many[k]->triangles.has_value());
    if (one[k]->triangles) CHECK(one[k]->triangles->triangle_a == many[k]->triangles->triangle_a);
  }
  CHECK(!one[19] && !one[20]);  // no solid, though it was said to be one
  CHECK(one[18] && one[21]);
  bool thrown = false;
  try {
    climb(requests[19], Rung::aabb, Rung::triangles);
  } catch (const std::invalid_argument&) {
    thrown = true;
  }
  CHECK(thrown);
}

// Two balls beside each other.
Mesh large_pair() {
  Mesh mesh = uv_sphere(60);
  append(mesh, translate(mesh, {3, 0, 0}));
  return mesh;
}

void a_large_pair_alone_answers_as_any() {
  const auto balls = geometry(large_pair()), across = geometry(transform(large_pair(), shifted(1.5, 0, 0, 1.6)));
  for (const double x : {0.0, 0.7, 2.0, 3.3, 5.2, 5.5, 9.0}) {
    const auto a = placed(balls, shifted(0)), b = placed(across, shifted(x, 0.1));
    ClimbRequest request = asked(*a, *b);
    const Climb among_many = climb(request, Rung::aabb, Rung::triangles);
    request.alone = true;
    const Climb alone = climb(request, Rung::aabb, Rung::triangles);
    CHECK(alone.box_gap == among_many.box_gap && alone.hulls.has_value() == among_many.hulls.has_value());
    CHECK(alone.triangles.has_value() == among_many.triangles.has_value());
    if (alone.triangles) CHECK(alone.triangles->relation == among_many.triangles->relation);
    if (!alone.hulls || alone.triangles) continue;
    CHECK(alone.hulls->lower <= among_many.hulls->upper && alone.hulls->lower >= 0.99 * among_many.hulls->lower);
  }
}

// A band of triangles, closed to a tube around the z axis: a plain solid that is not convex, as inspect() leaves it.
Mesh ring(std::uint32_t around, std::uint32_t across, Vec3 centre, bool upright) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 6.283185307179586 * i / around, v = 6.283185307179586 * j / across, r = 2 + 0.5 * std::cos(v);
      const Vec3 p{r * std::cos(u), r * std::sin(u), 0.5 * std::sin(v)};
      mesh.vertices.push_back(centre + (upright ? Vec3{p.x, -p.z, p.y} : p));
      const std::uint32_t k = (i + 1) % around * across, l = (j + 1) % across;
      mesh.triangles.push_back({i * across + j, k + j, k + l});
      mesh.triangles.push_back({i * across + j, k + l, i * across + l});
    }
  }
  return mesh;
}

std::shared_ptr<Geometry> inspected(const Mesh& mesh) {
  const Inspection found = inspect(mesh, true);
  return std::make_shared<Geometry>(std::make_shared<Mesh>(found.mesh), found.topology.solid, found.topology.is_plain_solid());
}

std::unique_ptr<PlacedGeometry> as_in_file(const std::shared_ptr<Geometry>& shared) {
  return std::make_unique<PlacedGeometry>(shared, std::nullopt, bounds_of(*shared->mesh()), 1e-9);
}

void a_surface_cut_down_to_what_matters_answers_as_all_of_it() {
  const auto lying = inspected(ring(160, 60, {0, 0, 0}, false));
  CHECK(lying->plain());
  int relations[6] = {};
  for (const double x : {1.0, 1.49, 1.5, 2.0, 2.5, 3.0, 3.01, 3.5, 4.0, 4.9, 4.99}) {
    const auto a = as_in_file(lying), b = as_in_file(inspected(ring(150, 70, {x, 0.01, 0.02}, true)));
    for (const double gap : {0.0, 1e-9, 1e-2}) {
      ClimbRequest request{a.get(), b.get(), gap, gap, gap / 2, gap / 2, false};
      const Climb among_many = climb(request, Rung::triangles, Rung::triangles);
      request.alone = true;
      const Climb alone = climb(request, Rung::triangles, Rung::triangles);
      CHECK(alone.triangles->relation == among_many.triangles->relation);
      ++relations[static_cast<int>(alone.triangles->relation)];
      CHECK(alone.gap.has_value() == among_many.gap.has_value());
      if (alone.gap) CHECK(alone.gap->distance == among_many.gap->distance && alone.gap_of_holes == among_many.gap_of_holes);
      CHECK(alone.least_depth.has_value() == among_many.least_depth.has_value());
      if (alone.least_depth) CHECK((*alone.least_depth > 0) == (*among_many.least_depth > 0));
    }
  }
  CHECK(lying->hierarchies() > 10);  // one of all of it, the others cut down
  CHECK(relations[static_cast<int>(Relation::separated)] > 5 && relations[static_cast<int>(Relation::penetrating)] > 5);
}

void what_was_let_go_is_made_again() {
  const auto shell = geometry(hollow());
  const auto body = placed(shell, shifted(1, 2, 3, 0.5));
  const std::shared_ptr<Surface> before = body->surface();
  CHECK(body->surface() == before);
  body->release();
  CHECK(body->surface() != before && body->surface()->mesh.vertices == before->mesh.vertices);
  CHECK(shell->hierarchies() == 1 && shell->refits() == 2);
}

}  // namespace

UNIT(climb) {
  the_lowest_rung_that_settles_ends_it();
  what_triangles_find();
  many_answer_as_one_by_one();
  a_large_pair_alone_answers_as_any();
  a_surface_cut_down_to_what_matters_answers_as_all_of_it();
  what_was_let_go_is_made_again();
}
