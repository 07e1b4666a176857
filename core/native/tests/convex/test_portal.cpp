// Portals against exact signs: what they find is right, and what they leave open is close to touching.
#include "convex/portal.hpp"
#include "convex/exact_depth.hpp"
#include "convex/narrow_phase.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

PortalFinding find(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const MinkowskiDifference m(a, pose_a, b, pose_b);
  return seek_portal(m, m.support_error()).finding;
}

Pose pose_at(double x, double y, double z) {
  Pose pose;
  pose.translation = {x, y, z};
  return pose;
}

// Vertices on an even grid: many pairs touch, and rays pass through edges and vertices.
std::vector<Vec3> grid_points(testing::Source& source, int count) {
  std::vector<Vec3> points;
  const auto coordinate = [&] { return std::round(source.uniform(-2, 2)); };
  for (int i = 0; i < count; ++i) points.push_back({coordinate(), coordinate(), coordinate()});
  return points;
}

void test_grids_against_exact_signs() {
  testing::Source source(3);
  int apart = 0, overlaps = 0;
  for (int round = 0; round < testing::rounds(4000); ++round) {
    const std::vector<Vec3> pa = grid_points(source, 1 + round % 11);
    std::vector<Vec3> pb = grid_points(source, 1 + round % 7);
    const Vec3 shift = grid_points(source, 1)[0];
    for (Vec3& p : pb) p = p + shift * 2;
    const Shape a = make_hull(pa), b = make_hull(pb);
    const PortalFinding finding = find(a, {}, b, {});
    const int truth = compare_depth(ExactDifference(pa, pb), Dyadic());
    if (finding == PortalFinding::apart) CHECK(truth < 0);
    if (finding == PortalFinding::overlaps) CHECK(truth > 0);
    apart += finding == PortalFinding::apart;
    overlaps += finding == PortalFinding::overlaps;
  }
  CHECK(apart > testing::rounds(1000));
  CHECK(overlaps > testing::rounds(200));
}

// Of pairs in general position that lie farther than rounding from touching, none is left open.
void test_general_pairs_are_settled() {
  testing::Source source(5);
  int overlaps = 0;
  for (int round = 0; round < testing::rounds(2000); ++round) {
    const Shape a = make_hull(source.sphere_points(4 + round % 90)), b = make_hull(source.sphere_points(4 + round % 70));
    const Pose pa = source.pose(0.9), pb = source.pose(0.9);
    const PortalFinding finding = find(a, pa, b, pb);
    const Outcome truth = check_pair(a, pa, b, pb, Query::depth).outcome;
    CHECK(finding == (truth == Outcome::separated ? PortalFinding::apart : PortalFinding::overlaps));
    overlaps += truth == Outcome::penetrating;
  }
  CHECK(overlaps > testing::rounds(500) && overlaps < testing::rounds(1900));
}

void test_curved_shapes() {
  const Shape cylinder = make_cylinder(1, 1), ball = make_ellipsoid({1, 2, 1});
  CHECK(find(cylinder, {}, cylinder, pose_at(2.01, 0, 0.1)) == PortalFinding::apart);
  CHECK(find(cylinder, {}, cylinder, pose_at(1.99, 0.1, 0.2)) == PortalFinding::overlaps);
  CHECK(find(cylinder, {}, ball, pose_at(0.3, 3.01, 0)) == PortalFinding::apart);
  CHECK(find(cylinder, {}, ball, pose_at(0.3, 2.9, 0.1)) == PortalFinding::overlaps);
}

// Directions grow with the cube of the scale, and no support point may lose them.
void test_curved_shapes_of_any_size() {
  for (const double size : {1e-40, 1.0, 1e40}) {
    const Shape ball = make_ellipsoid({size, 2 * size, 0.5 * size}), cone = make_cone(size, size);
    testing::Source source(7);
    int overlaps = 0;
    for (int round = 0; round < 400; ++round) {
      Pose pa = source.pose(1), pb = source.pose(1);
      pa.translation = pa.translation * size;
      pb.translation = pb.translation * size;
      const Shape& other = round % 2 ? ball : cone;
      const PortalFinding finding = find(ball, pa, other, pb);
      const Outcome truth = check_pair(ball, pa, other, pb, Query::depth).outcome;
      CHECK(finding == (truth == Outcome::separated ? PortalFinding::apart : PortalFinding::overlaps));
      overlaps += truth == Outcome::penetrating;
    }
    CHECK(overlaps > 100 && overlaps < 390);
  }
}

void test_what_touches_or_is_flat_stays_open() {
  const Shape box = make_box({1, 1, 1}), point = make_hull({{0, 0, 0}});
  CHECK(find(box, {}, box, pose_at(2, 0.3, 0.1)) == PortalFinding::open);
  CHECK(find(box, {}, box, {}) == PortalFinding::overlaps);
  CHECK(find(point, {}, point, {}) == PortalFinding::open);
  CHECK(find(point, {}, point, pose_at(1, 0, 0)) == PortalFinding::apart);
  // Too small for squares of areas: nothing is concluded from what has underflowed.
  const Shape speck = make_box({1e-45, 1e-45, 1e-45});
  CHECK(find(speck, {}, speck, pose_at(1.99e-45, 0.1e-45, 0.2e-45)) != PortalFinding::apart);
  CHECK(find(speck, {}, speck, pose_at(2.01e-45, 0.1e-45, 0.2e-45)) != PortalFinding::overlaps);
}

}  // namespace

UNIT(portal) {
  test_grids_against_exact_signs();
  test_general_pairs_are_settled();
  test_curved_shapes();
  test_curved_shapes_of_any_size();
  test_what_touches_or_is_flat_stays_open();
}
