// Analytic pairs, and SAT, GJK and EPA against each other: they share the support functions only.
#include <initializer_list>

#include "base/rounding.hpp"
#include "convex/narrow_phase.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

Pose at(double x, double y, double z) {
  Pose pose;
  pose.translation = {x, y, z};
  return pose;
}

// Results may differ from the truth by the support error of both sides of the comparison.
bool near(double value, double truth, double scale) { return std::fabs(value - truth) <= 2 * kSupportError * scale; }

void check_consistency(const PairResult& r, double scale) {
  CHECK(r.has_distance);
  CHECK(near(norm(r.normal), 1, 1));
  CHECK(r.lower <= r.distance && r.distance <= r.upper);
  const Vec3 miss = r.witness_b - r.witness_a - r.normal * r.distance;
  CHECK(norm(miss) <= 4 * kSupportError * scale);
}

void test_boxes_by_hand() {
  const Shape box = make_box({0.5, 0.5, 0.5});
  const PairResult deep = check_pair(box, at(0, 0, 0), box, at(0.25, 0.1, 0), Query::depth);
  CHECK(deep.outcome == Outcome::penetrating);
  CHECK(near(deep.distance, -0.75, 2));
  CHECK(deep.normal == (Vec3{1, 0, 0}));
  check_consistency(deep, 2);
  const PairResult apart = check_pair(box, at(0, 0, 0), box, at(0, 4, 3), Query::distance);
  CHECK(apart.outcome == Outcome::separated);
  CHECK(near(apart.distance, std::hypot(3.0, 2.0), 5));
  check_consistency(apart, 5);
}

void test_box_contacts_touch() {
  const Shape box = make_box({0.5, 0.5, 0.5});
  for (const Pose& pose : {at(1, 0, 0), at(1, 0.3, 0.2), at(1, 1, 0), at(1, 1, 1), at(-1, 0.5, -1)}) {
    for (const MethodChoice method : {MethodChoice::automatic, MethodChoice::sat, MethodChoice::gjk}) {
      const PairResult r = check_pair(box, at(0, 0, 0), box, pose, Query::depth, method);
      CHECK(r.outcome == Outcome::touching);
      CHECK(r.distance == 0 && r.lower == 0 && r.upper == 0);
    }
  }
  const double ulp = 0x1p-52;
  CHECK(check_pair(box, {}, box, at(1 + ulp, 0, 0), Query::depth).outcome == Outcome::separated);
  CHECK(check_pair(box, {}, box, at(1 - ulp / 2, 0, 0), Query::depth).outcome == Outcome::penetrating);
}

// The portal leaves them open, and the face they share proves them without another stage in float64.
void test_flush_hulls_in_place() {
  const auto block = [](double start, double end) {
    return make_hull({{start, 0, 0}, {start, 1, 0}, {start, 0, 1}, {start, 1, 1}, {end, 0, 0}, {end, 1, 0}, {end, 0, 1}});
  };
  const PairResult r = check_pair(block(0, 1), {}, block(1, 3), {}, Query::overlap);
  CHECK(r.outcome == Outcome::touching && r.method == Method::exact);
  CHECK(r.portal_rounds > 0 && r.gjk_iterations == 0 && r.epa_iterations == 0);
}

void test_spheres_and_capsules() {
  const Shape small = make_sphere(1), big = make_sphere(2), pill = make_capsule(0.5, 2);
  check_consistency(check_pair(small, at(0, 0, 0), big, at(5, 0, 0), Query::distance), 8);
  CHECK(near(check_pair(small, {}, big, at(5, 0, 0), Query::distance).distance, 2, 8));
  CHECK(near(check_pair(small, {}, big, at(0, 1, 0), Query::depth).distance, -2, 4));
  const PairResult concentric = check_pair(small, {}, big, {}, Query::depth);
  CHECK(concentric.outcome == Outcome::penetrating);
  CHECK(near(concentric.distance, -3, 3));
  check_consistency(concentric, 3);
  CHECK(check_pair(small, {}, big, at(3, 0, 0), Query::depth).outcome == Outcome::touching);
  CHECK(near(check_pair(pill, {}, small, at(3, 0, 1), Query::distance).distance, 1.5, 8));
  CHECK(near(check_pair(pill, {}, small, at(0, 0, 3), Query::depth).distance, -0.5, 8));
  const PairResult crossed = check_pair(pill, {}, pill, at(0.25, 0, 0), Query::depth);
  CHECK(near(crossed.distance, -0.75, 8));
  check_consistency(crossed, 8);
}

void test_round_shapes_by_hand() {
  // Curved bounds close to kCurvedGap of the scale.
  const double tolerance = 20 * kCurvedGap;
  const Shape cylinder = make_cylinder(1, 1), cone = make_cone(1, 1), ball = make_ellipsoid({1, 1, 1});
  const Shape box = make_box({1, 1, 1});
  CHECK(std::fabs(check_pair(cylinder, {}, cylinder, at(3, 0, 0), Query::distance).distance - 1) < tolerance);
  CHECK(std::fabs(check_pair(cylinder, {}, cylinder, at(1.5, 0, 0), Query::depth).distance + 0.5) < tolerance);
  CHECK(std::fabs(check_pair(cylinder, {}, box, at(0, 0, 1.75), Query::depth).distance + 0.25) < tolerance);
  CHECK(std::fabs(check_pair(cone, {}, box, at(0, 0, 3), Query::distance).distance - 1) < tolerance);
  CHECK(std::fabs(check_pair(ball, {}, ball, at(0, 1.5, 0), Query::depth).distance + 0.5) < tolerance);
  CHECK(std::fabs(check_pair(ball, {}, ball, at(0, 2.5, 0), Query::distance).distance - 0.5) < tolerance);
}

void test_flat_shapes() {
  const Shape point = make_hull({{0, 0, 0}});
  const Shape segment = make_hull({{-1, 0, 0}, {1, 0, 0}});
  const Shape square = make_hull({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  const Shape box = make_box({1, 1, 1});
  CHECK(square.polytope.dimension == 2 && segment.polytope.dimension == 1 && point.polytope.dimension == 0);
  CHECK(check_pair(point, {}, point, {}, Query::depth).outcome == Outcome::touching);
  CHECK(check_pair(point, {}, segment, at(0.5, 0, 0), Query::depth).outcome == Outcome::touching);
  CHECK(check_pair(segment, {}, segment, at(1, 0, 0), Query::depth).outcome == Outcome::touching);
  CHECK(check_pair(segment, {}, segment, at(2.5, 0, 0), Query::depth).outcome == Outcome::separated);
  CHECK(check_pair(square, {}, square, at(0.5, 0.5, 0), Query::depth).outcome == Outcome::touching);
  CHECK(check_pair(square, {}, square, at(0, 0, 1), Query::distance).distance == 1);
  CHECK(check_pair(point, {}, box, {}, Query::depth).outcome == Outcome::penetrating);
  CHECK(near(check_pair(point, {}, box, at(0.75, 0, 0), Query::depth).distance, -0.25, 2));
  CHECK(check_pair(point, {}, box, at(1, 0, 0), Query::depth).outcome == Outcome::touching);
  CHECK(near(check_pair(square, {}, box, at(0, 0, 0.5), Query::depth).distance, -0.5, 3));
}

void test_identical_and_concentric() {
  testing::Source source(7);
  for (int count : {4, 8, 12, 40, 120}) {
    const Shape hull = make_hull(source.sphere_points(count));
    const PairResult first = check_pair(hull, {}, hull, {}, Query::depth);
    const PairResult again = check_pair(hull, {}, hull, {}, Query::depth);
    CHECK(first.outcome == Outcome::penetrating);
    CHECK(first.normal == again.normal && first.distance == again.distance);
    const PairResult sat = check_pair(hull, {}, hull, {}, Query::depth, MethodChoice::sat);
    CHECK(near(first.distance, sat.distance, 4));
  }
}

void test_methods_agree() {
  testing::Source source(11);
  int overlaps = 0;
  for (int round = 0; round < 600; ++round) {
    const Shape a = make_hull(source.sphere_points(4 + round % 30)), b = make_hull(source.sphere_points(4 + round % 17));
    const Pose pa = source.pose(0.9), pb = source.pose(0.9);
    const PairResult sat = check_pair(a, pa, b, pb, Query::depth, MethodChoice::sat);
    const PairResult gjk = check_pair(a, pa, b, pb, Query::depth, MethodChoice::gjk);
    CHECK(sat.outcome == gjk.outcome);
    CHECK(near(sat.distance, gjk.distance, 4));
    CHECK(check_pair(a, pa, b, pb, Query::overlap).outcome == sat.outcome);
    check_consistency(gjk, 4);
    check_consistency(sat, 4);
    overlaps += sat.outcome == Outcome::penetrating;
  }
  CHECK(overlaps > 100 && overlaps < 500);  // both kinds were met
}

void test_swap_negates() {
  testing::Source source(13);
  for (int round = 0; round < 200; ++round) {
    const Shape a = make_hull(source.sphere_points(20)), b = make_hull(source.sphere_points(9));
    const Pose pa = source.pose(0.8), pb = source.pose(0.8);
    const PairResult ab = check_pair(a, pa, b, pb, Query::depth), ba = check_pair(b, pb, a, pa, Query::depth);
    CHECK(ab.outcome == ba.outcome);
    CHECK(near(ab.distance, ba.distance, 4));
  }
}

void test_powers_of_two_scale_exactly() {
  testing::Source source(19);
  for (int round = 0; round < 100; ++round) {
    std::vector<Vec3> pa = source.sphere_points(15), pb = source.sphere_points(15);
    for (Vec3& p : pb) p = p + Vec3{0.8, 0.3, 0};
    const PairResult unit = check_pair(make_hull(pa), {}, make_hull(pb), {}, Query::depth);
    for (double factor : {0x1p-30, 0x1p30}) {
      std::vector<Vec3> sa = pa, sb = pb;
      for (Vec3& p : sa) p = p * factor;
      for (Vec3& p : sb) p = p * factor;
      const PairResult scaled = check_pair(make_hull(sa), {}, make_hull(sb), {}, Query::depth);
      CHECK(scaled.distance == unit.distance * factor);
      CHECK(scaled.normal == unit.normal);
    }
  }
}

}  // namespace

UNIT(narrow_phase) {
  test_boxes_by_hand();
  test_box_contacts_touch();
  test_flush_hulls_in_place();
  test_spheres_and_capsules();
  test_round_shapes_by_hand();
  test_flat_shapes();
  test_identical_and_concentric();
  test_methods_agree();
  test_swap_negates();
  test_powers_of_two_scale_exactly();
}
