// The verdict by a face against the full exact stage, on small integer polytopes: many are flush, and some are points,
// segments or polygons.
#include <random>

#include "convex/convex_hull.hpp"
#include "convex/exact_pair.hpp"
#include "convex/separating_face.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

constexpr double kSlack = 1e-13;  // several support errors at this size

Polytope random_hull(std::mt19937& engine, int most, Vec3 shift) {
  std::uniform_int_distribution<int> coordinate(0, 3), count(1, most);
  std::vector<Vec3> points(count(engine));
  for (Vec3& p : points) {
    p = Vec3{double(coordinate(engine)), double(coordinate(engine)), double(coordinate(engine))} + shift;
  }
  return convex_hull(points);
}

void test_against_the_exact_stage() {
  std::mt19937 engine(7);
  std::uniform_int_distribution<int> shift(-3, 3);
  int touching = 0, separated = 0;
  for (int round = 0; round < 6000; ++round) {
    const Vec3 offset{double(shift(engine)), double(shift(engine)), double(shift(engine))};
    const Polytope a = random_hull(engine, 12, {0, 0, 0}), b = random_hull(engine, 12, offset);
    const Outcome truth = decide_exactly(a, b, kSlack);
    for (Vec3 axis : {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, offset}) {
      const std::optional<Outcome> by_face = outcome_by_face(a, b, axis);
      if (!by_face) continue;
      CHECK(*by_face == truth);
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
    const auto outcome = outcome_by_face(convex_hull(below), convex_hull(above), {0, 0, 1});
    CHECK(outcome == (start > 1 ? Outcome::separated : Outcome::touching));
  }
}

void test_no_proof_for_an_overlap() {
  const Polytope hull = convex_hull({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}});
  for (Vec3 axis : {Vec3{1, 0, 0}, {0, 0, -1}, {1, 1, 1}}) CHECK(!outcome_by_face(hull, hull, axis));
}

}  // namespace

UNIT(separating_face) {
  test_against_the_exact_stage();
  test_one_ulp_in_the_plane();
  test_no_proof_for_an_overlap();
}
