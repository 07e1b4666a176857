// A point deep in two bodies: met where they overlap by more, never where they overlap by less.
#include "ladder/touch_proof.hpp"

#include "convex/shape.hpp"
#include "mesh/topology.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

bool convex_thick(const Mesh& a, const Mesh& b, double least) {
  const PairResult hulls = check_pair(make_hull(a.vertices), {}, make_hull(b.vertices), {}, Query::depth);
  CHECK(hulls.outcome == Outcome::penetrating);
  return has_thick_point(a, b, hulls, least);
}

bool thick(const Mesh& a, const Mesh& b, double least) {
  const Surface of_a = make_surface(a, true), of_b = make_surface(b, true);
  return has_thick_point(of_a, of_b, mesh_relation(of_a, of_b), 10, least);
}

void boxes_overlap_in_a_slab() {
  const Mesh a = box({0, 0, 0}, {1, 1, 1}), b = box({0.75, 0, 0}, {2, 1, 1});
  for (const double least : {0.0, 1e-9, 1e-3, 0.0625}) CHECK(convex_thick(a, b, least) && thick(a, b, least));
  for (const double least : {0.125, 0.25, 1.0}) CHECK(!convex_thick(a, b, least) && !thick(a, b, least));
}

void a_body_inside_another() {
  const Mesh a = box({0, 0, 0}, {4, 4, 4}), b = box({1, 1, 1}, {2, 2, 2});
  CHECK(convex_thick(a, b, 0.25) && thick(a, b, 0.25) && convex_thick(b, a, 0.25));
  CHECK(!convex_thick(a, b, 0.5) && !thick(a, b, 0.5));
}

void without_witnesses_nothing_is_claimed() {
  PairResult hulls;
  hulls.lower = hulls.upper = -1;
  CHECK(!has_thick_point(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}), hulls, 1e-9));
}

// Deep, as the way out is long, and thin.
void a_needle_through_a_box() {
  const Mesh a = box({0, 0, 0}, {1, 1, 1}), b = box({-1, 0.5, 0.5}, {2, 0.5 + 1e-3, 0.5 + 1e-3});
  CHECK(convex_thick(a, b, 1e-6) && !convex_thick(a, b, 5e-4));
}

Mesh placed(Mesh mesh, const Pose& pose) {
  for (Vec3& v : mesh.vertices) v = pose.rotation * v + pose.translation;
  return mesh;
}

// The vertices move by no more than 1e-14 when they are placed.
void flush_boxes_overlap_by_rounding_alone() {
  int overlaps = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    Source random(seed);
    const Pose pose = random.pose(8);
    const Vec3 low{1, random.uniform(-1, 1), random.uniform(-2, 2)};
    const Vec3 high{random.uniform(1.5, 3), random.uniform(1.1, 3), random.uniform(2.1, 4)};
    const Surface a = make_surface(placed(box({0, 0, 0}, {1, 2, 3}), pose), true);
    const Surface b = make_surface(placed(box(low, high), pose), true);
    const MeshRelation relation = mesh_relation(a, b);
    if (relation.relation != Relation::penetrating) continue;
    ++overlaps;
    CHECK(!has_thick_point(a, b, relation, 16, 1e-12));
  }
  CHECK(overlaps > 0);
}

}  // namespace

UNIT(touch_proof) {
  boxes_overlap_in_a_slab();
  a_body_inside_another();
  a_needle_through_a_box();
  without_witnesses_nothing_is_claimed();
  flush_boxes_overlap_by_rounding_alone();
}
