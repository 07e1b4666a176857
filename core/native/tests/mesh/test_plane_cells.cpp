// The winding numbers beside each cell of a patch, against a ray from a point inside it.
#include "mesh/plane_cells.hpp"

#include <algorithm>
#include <random>

#include "mesh/self_contact.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

Surface joined(const std::vector<Mesh>& parts) {
  Mesh all;
  for (const Mesh& part : parts) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Triangle& t : part.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return make_surface(all, true);
}

// A triangle and its reverse: a sheet.
Mesh sheet(Vec3 p, Vec3 q, Vec3 r) { return {{p, q, r}, {{0, 1, 2}, {0, 2, 1}}}; }

// Returns the number of cells in the patch. Each is what rays say, and lies in the triangles whose cells it is among.
std::size_t check_patch(const Surface& a, const Surface& b, PatchTriangle first) {
  const PlaneCells cells({&a, &b}, first, SinglePoints::left_out, nullptr);
  const Mesh& mesh = first.surface == 0 ? a.mesh : b.mesh;
  const Corners c = corners(mesh, first.triangle);
  for (const std::uint32_t cell : cells.cells()) {
    const ExactPoint p = cells.inside(cell);
    CHECK(orientation(c[0], c[1], c[2], p) == 0);
    const std::vector<PatchTriangle> at = cells.members_at(p);
    for (const int s : {0, 1}) {
      const Surface& surface = s == 0 ? a : b;
      const auto sides = cells.beside(cell, s), truth = winding_beside(surface.mesh, surface.bvh, p, c[0], c[1], c[2]);
      CHECK(sides && truth);
      if (!sides || !truth) continue;
      CHECK(sides->front == truth->front && sides->back == truth->back && sides->on_surface == truth->on_surface);
      CHECK(std::any_of(at.begin(), at.end(), [&](PatchTriangle t) { return t.surface == s; }) == truth->on_surface);
    }
    for (const PatchTriangle& member : cells.members()) {
      const Corners t = corners(member.surface == 0 ? a.mesh : b.mesh, member.triangle);
      CHECK((std::find(at.begin(), at.end(), member) != at.end()) == plane_point_in_triangle(p, t[0], t[1], t[2]));
    }
  }
  return cells.cells().size();
}

void check_all(const Surface& a, const Surface& b) {
  for (const int s : {0, 1}) {
    const Mesh& mesh = s == 0 ? a.mesh : b.mesh;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 5) {
      const Corners c = corners(mesh, t);
      if (!collinear(c[0], c[1], c[2])) check_patch(a, b, {s, t});
    }
  }
}

void a_lid_and_its_neighbours() {
  const Surface box_a = joined({box({0, 0, 0}, {4, 4, 4})});
  // On the lid: a smaller box, half of whose face reaches beyond it, and a wall that stands through it.
  const Surface box_b = joined({box({2, 1, 4}, {6, 2, 5}), box({1, -1, 3}, {1.5, 5, 6})});
  std::uint32_t lid = 0;
  while (std::any_of(box_a.mesh.triangles[lid].begin(), box_a.mesh.triangles[lid].end(),
                     [&](std::uint32_t v) { return box_a.mesh.vertices[v].z != 4; })) {
    ++lid;
  }
  CHECK(check_patch(box_a, box_b, {0, lid}) > 6);
  check_all(box_a, box_b);
}

void an_island_within_a_triangle() {
  const Surface large = joined({sheet({0, 0, 0}, {9, 0, 0}, {0, 9, 0})});
  const Surface small = joined({sheet({1, 1, 0}, {2, 1, 0}, {1, 2, 0}), box({3, 3, -1}, {3.5, 3.5, 1})});
  // The large triangle, the small one and the section of the box.
  CHECK(check_patch(large, small, {0, 0}) == 3);
}

// A pipe and a rod in it, which stand through a triangle: outlines around each other, none of which meet.
void islands_within_islands() {
  const Surface large = joined({sheet({0, 0, 0}, {9, 0, 0}, {0, 9, 0})});
  const auto column = [](double low, double high) { return box({low, low, -1}, {high, high, 1}); };
  const Surface pipe = joined({column(0.5, 4), reversed(column(1, 3)), column(1.5, 2), column(3.25, 3.5)});
  // Around the pipe, the pipe between its walls, the bore around the rod, the rod, and one that is within the pipe.
  CHECK(check_patch(large, pipe, {0, 0}) == 5);
}

void lattices_and_soups() {
  std::mt19937 generator(41);
  std::uniform_int_distribution<int> coarse(0, 4);
  std::uniform_real_distribution<double> fine(0, 4);
  for (int round = 0; round < (kSanitized ? 10 : 60); ++round) {
    const auto number = [&] { return round % 3 == 0 ? fine(generator) : coarse(generator) * (round % 3 == 1 ? 0.1 : 1.0); };
    const auto make = [&] {
      std::vector<Mesh> parts;
      for (int k = 0; k < 4; ++k) {
        const bool flat = k < 3;
        const auto point = [&] { return Vec3{number(), number(), flat ? 0.1 : number()}; };
        const Vec3 p = point(), q = point(), r = point();
        if (!collinear(p, q, r)) parts.push_back(sheet(p, q, r));
        const Vec3 s{number(), number(), 0.1}, t{number(), number(), number()};
        if (s.x < t.x && s.y < t.y && s.z < t.z) parts.push_back(box(s, t));
      }
      parts.push_back(box({1, 1, 0.1}, {2, 2, 1}));
      return joined(parts);
    };
    const Surface a = make(), b = make();
    check_all(a, b);
  }
}

}  // namespace

UNIT(plane_cells) {
  a_lid_and_its_neighbours();
  an_island_within_a_triangle();
  islands_within_islands();
  lattices_and_soups();
}
