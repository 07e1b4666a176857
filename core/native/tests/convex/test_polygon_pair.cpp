// Two convex polygons: known figures, exact contacts, tiny figures.
#include "convex/polygon_pair.hpp"

#include "tests/check.hpp"
#include "tests/convex/polygons.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

PairResult check(const Corners& a, const Corners& b, Query query = Query::depth) {
  const ConvexPolygons polygons = pair_of(a, b);
  return check_polygons(polygons[0], polygons[1], query);
}

Outcome outcome(const Corners& a, const Corners& b) { return check(a, b, Query::overlap).outcome; }

void test_depth() {
  const PairResult r = check(square(0, 0, 2), square(1.5, 0.25, 2));
  CHECK(r.outcome == Outcome::penetrating && r.distance == -0.5);
  CHECK(r.normal == (Vec3{1, 0, 0}) && r.feature == Feature::face_a && r.index_a == 1);
  // A small square inside a big one leaves by the shorter way.
  const PairResult inside = check(square(1, 4, 1), square(0, 0, 10));
  CHECK(inside.distance == -2 && inside.normal == (Vec3{1, 0, 0}));
  CHECK(inside.witness_a == (Vec3{2, 4, 0}) || inside.witness_a == (Vec3{2, 5, 0}));
  const PairResult diamond = check({{0, -1}, {1, 0}, {0, 1}, {-1, 0}}, square(0.25, 0.25, 1));
  CHECK(diamond.outcome == Outcome::penetrating);
  CHECK(std::fabs(diamond.distance + 0.5 / std::sqrt(2.0)) < 1e-15);
}

void test_distance() {
  const PairResult face = check(square(0, 0, 2), {{3, 1}, {5, 0}, {5, 2}}, Query::distance);
  CHECK(face.distance == 1 && face.witness_a == (Vec3{2, 1, 0}) && face.witness_b == (Vec3{3, 1, 0}));
  const PairResult corners = check(square(0, 0, 1), square(4, 5, 1), Query::distance);
  CHECK(corners.distance == 5 && corners.feature == Feature::vertices);
  CHECK(corners.witness_a == (Vec3{1, 1, 0}) && corners.witness_b == (Vec3{4, 5, 0}));
  const PairResult mirrored = check(square(4, 5, 1), square(0, 0, 1), Query::distance);
  CHECK(mirrored.distance == 5 && mirrored.normal == -corners.normal && mirrored.witness_b == corners.witness_a);
}

void test_contacts_are_exact() {
  CHECK(outcome(square(0, 0, 1), square(1, 0.5, 1)) == Outcome::touching);
  CHECK(outcome(square(0, 0, 1), square(1, 1, 1)) == Outcome::touching);
  CHECK(outcome(square(0, 0, 1), square(1 + 0x1p-52, 0, 1)) == Outcome::separated);
  CHECK(outcome(square(0, 0, 1), square(1 - 0x1p-53, 0, 1)) == Outcome::penetrating);
  CHECK(outcome({{0, 0}, {2, 0}, {0, 2}}, square(1, 1, 1)) == Outcome::touching);
  CHECK(outcome({{0, 0}, {2, 0}, {0, 2}}, square(2, -1, 1)) == Outcome::touching);   // a corner on a line and an edge
  CHECK(outcome({{0, 0}, {2, 0}, {0, 2}}, square(3, -1, 1)) == Outcome::separated);  // on a line, beyond the edge
}

void test_tiny_figures() {
  const double ulp = 0x1p-52;
  CHECK(check(square(0, 0, 1), square(1 + ulp, 0, 1)).distance == ulp);
  CHECK(check(square(0, 0, 1), square(1 - ulp, 0.5, 1)).distance == -ulp);
  // A corner an ulp beyond a slope.
  const PairResult slope = check({{0, 0}, {2, 0}, {0, 2}}, square(1 + ulp, 1, 1), Query::distance);
  CHECK(slope.outcome == Outcome::separated && std::fabs(slope.distance / (ulp / std::sqrt(2.0)) - 1) < 1e-15);
  const PairResult deep = check({{0, 0}, {2, 0}, {0, 2}}, {{1 - ulp, 1}, {2, 1}, {2, 2}, {1 - ulp, 2}});
  CHECK(deep.outcome == Outcome::penetrating && std::fabs(deep.distance / (-ulp / std::sqrt(2.0)) - 1) < 1e-15);
  const PairResult near = check(square(-1, -1, 1), {{1e-200, 1e-200}, {1, 0.5}, {0.5, 1}}, Query::distance);
  CHECK(std::fabs(near.distance / (std::sqrt(2.0) * 1e-200) - 1) < 1e-15);
}

}  // namespace

UNIT(polygon_pair) {
  test_depth();
  test_distance();
  test_contacts_are_exact();
  test_tiny_figures();
}
