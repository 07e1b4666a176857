#include "mesh_pair/covers_once.hpp"

#include <algorithm>

#include "base/key_sort.hpp"
#include "exact/predicates.hpp"
#include "mesh/self_contact.hpp"
#include "mesh_pair/samples.hpp"

namespace satcheck {
namespace {

// Whether a condition holds beside every piece. False if a sample gives no answer.
template <class Holds>
bool holds_beside_all(const Surface& solid, Holds holds) {
  bool all_hold = true;
  const auto note = [&](const std::optional<Beside>& sides) { all_hold = all_hold && sides && holds(*sides); };
  const auto all = [](std::uint32_t) { return true; };
  const auto plain = [&](std::uint32_t t) {
    const Corners c = corners(solid.mesh, t);
    note(beside_inner(solid, lazy_centroid(c), t, nullptr));
    return all_hold;
  };
  const auto patch = [&](const PlaneCells& cells) {
    for (const std::uint32_t cell : cells.cells()) note(cells.beside(cell, 0));
    return all_hold;
  };
  visit_uniform_parts({&solid}, all, plain, patch);
  return all_hold;
}

// The triangles without copies that face the same way.
std::vector<std::array<std::uint32_t, 3>> distinct_triangles(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> distinct;
  for (const auto& t : mesh.triangles) {
    std::array<std::uint32_t, 3> corners{t[0], t[1], t[2]};
    std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
    distinct.push_back(corners);
  }
  sort_once(distinct);
  return distinct;
}

// Whether two triangles that may overlap lie in one plane and face away from each other. Winding numbers differ by one
// across a triangle, so that only the other triangles of its plane can make both sides equal.
bool has_opposite_triangles(const Surface& solid) {
  const Mesh& mesh = solid.mesh;
  for (const auto& [p, q, r] : distinct_triangles(mesh)) {
    const Corners c{mesh.vertices[p], mesh.vertices[q], mesh.vertices[r]};
    const TrianglePlane plane(c[0], c[1], c[2]);
    const int axis = projection_axis(rounded_normal(c[0], c[1], c[2])), turn = orientation_2d(c[0], c[1], c[2], axis);
    if (turn == 0) {
      if (!collinear(c[0], c[1], c[2])) return true;  // a normal that has no certain axis
      continue;
    }
    const bool none = visit_box(solid.bvh, mesh, bounds_of(c), [&](std::uint32_t other) {
      const Corners d = corners(mesh, other);
      const auto in_plane = [&](Vec3 p) { return plane.side(p) == 0; };
      return orientation_2d(d[0], d[1], d[2], axis) != -turn || !std::all_of(d.begin(), d.end(), in_plane);
    });
    if (!none) return true;
  }
  return false;
}

}  // namespace

bool covers_once(const Surface& solid) {
  const auto at_most_once = [](int winding) { return winding == 0 || winding == 1; };
  return holds_beside_all(solid, [&](const Beside& b) { return at_most_once(b.front) && at_most_once(b.back); });
}

bool has_sheets(const Surface& solid) {
  return has_opposite_triangles(solid) && !holds_beside_all(solid, [](const Beside& b) { return !b.is_sheet(); });
}

}  // namespace satcheck
