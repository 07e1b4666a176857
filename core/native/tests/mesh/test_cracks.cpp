// Cracks are closed, holes are not, and nothing that is there changes.
#include "mesh/cracks.hpp"

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
  return boundary_loops(mesh).empty();
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

// A face with a T-junction on each side: its own rim is a loop, and so is that of its neighbours.
void a_face_with_a_t_junction_on_each_side_is_closed() {
  const Mesh face{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  for (const double off : {0.0, 1e-7}) {
    Mesh mesh = face;
    for (std::uint32_t k = 0; k < 4; ++k) {
      mesh.vertices.push_back((face.vertices[k] + face.vertices[(k + 1) % 4]) * 0.5 + Vec3{0, 0, off});
    }
    mesh.vertices.push_back({1, 1, -2});
    for (std::uint32_t k = 0; k < 4; ++k) {
      mesh.triangles.insert(mesh.triangles.end(), {{4 + k, k, 8}, {(k + 1) % 4, 4 + k, 8}});
    }
    CHECK(seal_cracks(mesh, 2e-7) >= 1);
    CHECK(is_closed(mesh));
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

// A strip of squares and another one beside it, whose vertices differ in the last digit.
void a_seam_is_closed_along_any_axis() {
  for (int axis = 0; axis < 3; ++axis) {
    const auto turned = [&](double along, double across) { return axis == 0 ? Vec3{along, across, 0} : axis == 1 ? Vec3{0, along, across} : Vec3{across, 0, along}; };
    Mesh mesh;
    for (const double shift : {0.0, 1.0 + 1e-9}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (std::uint32_t i = 0; i <= 40; ++i) {
        for (const double across : {0.0, 1.0}) mesh.vertices.push_back(turned(i, across + shift));
      }
      for (std::uint32_t i = 0; i < 40; ++i) {
        const std::uint32_t p = first + 2 * i;
        mesh.triangles.insert(mesh.triangles.end(), {{p, p + 2, p + 3}, {p, p + 3, p + 1}});
      }
    }
    const std::size_t before = mesh.triangles.size();
    CHECK(seal_cracks(mesh, 1e-8) == 1);  // two rims become one
    CHECK(boundary_loops(mesh).size() == 1);
    CHECK(mesh.triangles.size() > before);
  }
}

}  // namespace

UNIT(cracks) {
  a_seam_is_closed_along_any_axis();
  a_t_junction_is_closed_within_the_width();
  a_face_with_a_t_junction_on_each_side_is_closed();
  what_is_wider_stays();
  a_width_as_large_as_the_mesh_closes_nothing();
}
