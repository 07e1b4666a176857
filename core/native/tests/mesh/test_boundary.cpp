// Loops of the boundary, and the holes and flat parts that they make.
#include "mesh/boundary.hpp"

#include "mesh/surface.hpp"
#include "mesh/topology.hpp"
#include "tests/check.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

Mesh tetrahedron() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}}; }

void closed_meshes_have_none() {
  CHECK(boundary_loops(tetrahedron()).empty());
  CHECK(find_holes(tetrahedron()).empty());
}

void a_missing_triangle_is_a_loop_of_three() {
  for (std::size_t missing = 0; missing < 4; ++missing) {
    Mesh mesh = tetrahedron();
    const Triangle gone = mesh.triangles[missing];
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(missing));
    const auto loops = boundary_loops(mesh);
    CHECK(loops.size() == 1 && loops[0].size() == 3);
    mesh.triangles.push_back(fan(loops[0])[0]);
    CHECK(boundary_loops(mesh).empty());
    for (const std::uint32_t v : loops[0]) CHECK(v == gone[0] || v == gone[1] || v == gone[2]);
  }
}

void a_turned_triangle_is_two_loops_in_one_hole() {
  Mesh mesh = tetrahedron();
  std::swap(mesh.triangles[2][1], mesh.triangles[2][2]);
  CHECK(boundary_loops(mesh).size() == 2);
  CHECK(find_holes(mesh).size() == 1);
  CHECK(close_surface(make_surface(mesh, false), OpenParts::filled).surface->solid);
}

void loops_that_share_a_vertex_are_one_hole() {
  // Two triangles that are missing from an octahedron and share a corner.
  Mesh mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{4, 0, 2}, {4, 2, 1}, {4, 1, 3}, {4, 3, 0}, {5, 2, 0}, {5, 1, 2}, {5, 3, 1}, {5, 0, 3}}};
  CHECK(boundary_loops(mesh).empty());
  mesh.triangles.erase(mesh.triangles.begin() + 2);
  mesh.triangles.erase(mesh.triangles.begin());
  CHECK(boundary_loops(mesh).size() == 2);
  CHECK(find_holes(mesh).size() == 1);
}

void a_flat_part_is_a_sheet_and_no_hole() {
  const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  CHECK(boundary_loops(square).size() == 1);
  Mesh doubled = square;
  double_triangles(doubled, flat_parts(square));
  CHECK(find_holes(doubled).empty());
  const Surface surface = make_surface(square, false);
  const Closing closing = close_surface(surface, OpenParts::filled);
  CHECK(closing.hulls.empty() && closing.surface->mesh.triangles.size() == 4);
  Mesh bent = square;
  bent.vertices[3].z = 0.25;
  CHECK(find_holes(bent).size() == 1);
  // As rounding may bend it.
  CHECK(close_surface(refitted_surface(surface, bent), OpenParts::filled).holes.empty());
  CHECK(close_surface(make_surface(bent, false), OpenParts::filled).holes.size() == 1);
}

}  // namespace

UNIT(boundary) {
  closed_meshes_have_none();
  a_missing_triangle_is_a_loop_of_three();
  a_turned_triangle_is_two_loops_in_one_hole();
  loops_that_share_a_vertex_are_one_hole();
  a_flat_part_is_a_sheet_and_no_hole();
}
