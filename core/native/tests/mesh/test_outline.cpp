// Outlines of prisms: which meshes have one, points in them, edges that meet.
#include "mesh/outline.hpp"

#include "tests/check.hpp"
#include "tests/mesh/prisms.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

void test_a_prism_has_an_outline() {
  const Surface surface = square_prism(-1, -1, 2, 5);
  const Outline* outline = outline_of(surface);
  CHECK(outline && outline->axis == 2 && outline->height == 5);
  CHECK(outline && outline->edges.size() == 4 && outline->loops.size() == 1);
  CHECK(outline && outline->holds({{0, 0}, {0, 0}}) && !outline->holds({{2, 0}, {2, 0}}));
  CHECK(outline == outline_of(surface));
}

void test_other_meshes_have_none() {
  CHECK(!outline_of(make_surface(square_mesh(0, 0, 2, 5, 0.5), true)));
  CHECK(!outline_of(square_prism(-1, -1, 2, 1)));  // low
  Mesh pyramid = square_mesh(-1, -1, 2, 5);
  pyramid.vertices[4].x = -0.5;
  CHECK(!outline_of(make_surface(pyramid, true)));
}

void test_points_between_two_points() {
  // The middle is on the left of the line by less than an ulp of any coordinate.
  const Vec2 p{1, 1}, q{2, 2 + 0x1p-51};
  CHECK(side_of({0, 0}, {4, 4}, {p, q}) == 1);
  CHECK(side_of({0, 0x1p-52}, {4, 4 + 0x1p-50}, {{1, 1 - 0x1p-52}, {3, 3}}) == -1);
  CHECK(side_of({0, 0}, {4, 4}, {{0, 1}, {1, 0}}) == 0);
}

OutlineEdge edge(Vec2 from, Vec2 to) { return {from, to, 0, {0, 0}}; }

void test_edges() {
  const OutlineEdge e = edge({0, 0}, {4, 0});
  CHECK(classify(e, edge({1, -1}, {1, 1})) == EdgeContact::crossing);
  CHECK(classify(e, edge({1, 0}, {1, 1})) == EdgeContact::touching);
  CHECK(classify(e, edge({4, 0}, {5, 1})) == EdgeContact::touching);
  CHECK(classify(e, edge({4, 1}, {4, -1})) == EdgeContact::touching);
  CHECK(classify(e, edge({5, 0}, {5, 1})) == EdgeContact::none);
  CHECK(classify(e, edge({3, 0}, {9, 0})) == EdgeContact::touching);
  CHECK(classify(e, edge({5, 0}, {9, 0})) == EdgeContact::none);
}

}  // namespace

UNIT(outline) {
  test_a_prism_has_an_outline();
  test_other_meshes_have_none();
  test_points_between_two_points();
  test_edges();
}
