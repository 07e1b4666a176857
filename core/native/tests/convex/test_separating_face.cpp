// The verdict by a face against the full exact stage, on small integer polytopes: many are flush, and some are points,
// segments or polygons. Those far from 0 for their size have an origin.
#include <random>

#include "convex/exact_depth.hpp"
#include "convex/separating_face.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

std::optional<Outcome> by_face(const Shape& a, const Shape& b, Vec3 axis) {
  return outcome_by_face(WorldHull(a, {}), WorldHull(b, {}), axis);
}

std::vector<Vec3> some_points(std::mt19937& engine, int most, Vec3 shift) {
  std::uniform_int_distribution<int> coordinate(0, 3), count(1, most);
  std::vector<Vec3> points(count(engine));
  for (Vec3& p : points) {
    p = Vec3{double(coordinate(engine)), double(coordinate(engine)), double(coordinate(engine))} + shift;
  }
  return points;
}

void test_against_the_exact_stage() {
  std::mt19937 engine(7);
  std::uniform_int_distribution<int> shift(-3, 3);
  int touching = 0, separated = 0;
  for (int round = 0; round < 6000; ++round) {
    const Vec3 offset{double(shift(engine)), double(shift(engine)), double(shift(engine))};
    const std::vector<Vec3> points_a = some_points(engine, 12, {0, 0, 0}), points_b = some_points(engine, 12, offset);
    const Shape a = make_hull(points_a), b = make_hull(points_b);
    const int depth = compare_depth(ExactDifference(points_a, points_b), Dyadic());
    const Outcome truth = depth < 0 ? Outcome::separated : depth > 0 ? Outcome::penetrating : Outcome::touching;
    for (Vec3 axis : {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, offset}) {
      const std::optional<Outcome> outcome = by_face(a, b, axis);
      if (!outcome) continue;
      CHECK(*outcome == truth);
      ++(truth == Outcome::touching ? touching : separated);
    }
  }
  CHECK(touching >= 1000 && separated >= 1000);
}

// A cube below a plane and a block above it: their outlines overlap, meet or miss by one ulp.
void test_one_ulp_in_the_plane() {
  std::vector<Vec3> below, above;
  for (int i = 0; i < 8; ++i) below.push_back({double(i & 1), double(i >> 1 & 1), -double(i >> 2)});
  for (double start : {std::nextafter(1.0, 0.0), 1.0, std::nextafter(1.0, 2.0)}) {
    above.clear();
    for (int i = 0; i < 8; ++i) above.push_back({i & 1 ? 2 : start, double(i >> 1 & 1), double(i >> 2)});
    CHECK(by_face(make_hull(below), make_hull(above), {0, 0, 1}) == (start > 1 ? Outcome::separated : Outcome::touching));
  }
}

void test_no_proof_for_an_overlap() {
  const Shape hull = make_hull({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}});
  for (Vec3 axis : {Vec3{1, 0, 0}, {0, 0, -1}, {1, 1, 1}}) CHECK(!by_face(hull, hull, axis));
}

}  // namespace

UNIT(separating_face) {
  test_against_the_exact_stage();
  test_one_ulp_in_the_plane();
  test_no_proof_for_an_overlap();
}
