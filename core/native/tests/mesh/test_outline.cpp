// Outlines of prisms: which meshes have one, points in them, edges that meet.
#include "mesh/outline.hpp"

#include "tests/check.hpp"

using namespace satcheck;

namespace {

// A square prism about the origin, welded.
Mesh box(double size, double height, double lift) {
  Mesh mesh;
  for (const double z : {-height + lift, height + lift}) {
    for (const Vec2 p : {Vec2{-size, -size}, Vec2{size, -size}, Vec2{size, size}, Vec2{-size, size}}) mesh.vertices.push_back({p.x, p.y, z});
  }
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t n = (k + 1) % 4;
    mesh.triangles.push_back({k, n, n + 4});
    mesh.triangles.push_back({k, n + 4, k + 4});
  }
  return mesh;
}

void test_a_prism_has_an_outline() {
  const Surface surface = make_surface(box(1, 5, 0), true);
  const Outline* outline = outline_of(surface);
  CHECK(outline && outline->axis == 2 && outline->height == 5);
  CHECK(outline && outline->edges.size() == 4 && outline->loops.size() == 1);
  CHECK(outline && outline->holds({{0, 0}, {0, 0}}) && !outline->holds({{2, 0}, {2, 0}}));
  CHECK(outline == outline_of(surface));
}

void test_other_meshes_have_none() {
  Mesh moved = box(1, 5, 0.5);
  for (Vec3& p : moved.vertices) p = p + Vec3{0.5, 0.5, 0};
  CHECK(!outline_of(make_surface(moved, true)));
  Mesh pyramid = box(1, 5, 0);
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
