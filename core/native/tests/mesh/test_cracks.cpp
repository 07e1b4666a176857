// Cracks are closed, holes are not, and nothing that is there changes.
#include "mesh/cracks.hpp"

#include "base/edge_table.hpp"
#include "mesh/boundary.hpp"
#include "mesh/surface.hpp"
#include "tests/check.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

// A tetrahedron whose base has one more vertex on an edge that the wall beside it does not have.
Mesh with_t_junction(double off) {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, off, 0}},
          {{0, 2, 4}, {4, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

bool is_closed(const Mesh& mesh) {
  return boundary_loops(mesh, EdgeTable(mesh.vertices.size(), mesh.triangles)).empty();
}

void a_t_junction_is_closed_within_the_width() {
  for (const double off : {0.0, 1e-7, -1e-7}) {
    Mesh mesh = with_t_junction(off);
    CHECK(!is_closed(mesh));
    CHECK(seal_cracks(mesh, 2e-7) == 1);
    CHECK(is_closed(mesh));
    CHECK(mesh.vertices == with_t_junction(off).vertices);
    const auto before = with_t_junction(off).triangles;
    CHECK(std::equal(before.begin(), before.end(), mesh.triangles.begin()));
  }
}

void what_is_wider_stays() {
  Mesh mesh = with_t_junction(1e-6);
  CHECK(seal_cracks(mesh, 2e-7) == 0);
  CHECK(mesh.triangles.size() == 5);
  Mesh missing = with_t_junction(0);
  missing.triangles.pop_back();
  CHECK(seal_cracks(missing, 2e-7) <= 1);
  CHECK(!is_closed(missing));
}

void a_width_as_large_as_the_mesh_closes_nothing() {
  Mesh mesh = with_t_junction(0);
  CHECK(seal_cracks(mesh, 0.5) == 0);
}

}  // namespace

UNIT(cracks) {
  a_t_junction_is_closed_within_the_width();
  what_is_wider_stays();
  a_width_as_large_as_the_mesh_closes_nothing();
}
