#include "covers_once.hpp"

#include <algorithm>
#include <vector>

#include "exact_point.hpp"
#include "incidence.hpp"
#include "predicates.hpp"
#include "triangle_pair.hpp"
#include "winding.hpp"

namespace satcheck {
namespace {

enum class SelfContact { none, touching, overlapping };

bool has_corner(const Triangle& t, std::uint32_t v) { return std::find(t.begin(), t.end(), v) != t.end(); }

// Are the corners of u that t does not have strictly on one side of its plane?
bool rises_on_one_side(const Mesh& mesh, const Triangle& t, const Triangle& u) {
  int first = 0;
  for (const std::uint32_t v : u) {
    if (has_corner(t, v)) continue;
    const std::vector<Vec3>& at = mesh.vertices;
    const int side = orientation(at[t[0]], at[t[1]], at[t[2]], at[v]);
    if (side == 0 || side == -first) return false;
    first = side;
  }
  return first != 0;
}

bool is_collinear(const Mesh& mesh, std::uint32_t t) {
  const Corners c = corners(mesh, t);
  return collinear(c[0], c[1], c[2]);
}

// Beyond the corners and the edge that neighbours share.
SelfContact self_contact(const Mesh& mesh, std::uint32_t t, std::uint32_t u) {
  const Triangle &vt = mesh.triangles[t], &vu = mesh.triangles[u];
  const auto shared = std::count_if(vt.begin(), vt.end(), [&](std::uint32_t v) { return has_corner(vu, v); });
  if (shared > 0 && (rises_on_one_side(mesh, vt, vu) || rises_on_one_side(mesh, vu, vt))) return SelfContact::none;
  const Corners ct = corners(mesh, t), cu = corners(mesh, u);
  if (shared < 2) {
    const TriangleContact contact = classify(ct, cu);
    if (contact == TriangleContact::disjoint) return SelfContact::none;
    if (contact == TriangleContact::crossing) return SelfContact::overlapping;
  }
  switch (coplanar_overlap(ct, cu)) {
    case CoplanarOverlap::agreeing: return SelfContact::overlapping;
    case CoplanarOverlap::opposing: return SelfContact::touching;
    case CoplanarOverlap::none: break;
  }
  if (shared == 2) return SelfContact::none;
  const bool corner_only = shared == 1 && meet_triangles(mesh, t, mesh, u).kind == MeetingKind::point;
  return corner_only ? SelfContact::none : SelfContact::touching;
}

bool is_once_beside(const Surface& solid, std::uint32_t t) {
  const Corners c = corners(solid.mesh, t);
  const ExactPoint p = weighted_point(c[0], c[1], c[2], 3.0, 4.0, 5.0);
  const auto once = [](int winding) { return winding == 0 || winding == 1; };
  const auto beside = winding_beside(solid.mesh, solid.bvh, p, c[0], c[1], c[2]);
  return beside && once(beside->front) && once(beside->back);
}

}  // namespace

bool covers_once(const Surface& solid) {
  const Mesh& mesh = solid.mesh;
  std::vector<bool> touching(mesh.triangles.size(), false);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_collinear(mesh, t)) continue;
    const Aabb box = triangle_box(mesh, t);
    const bool apart = visit_box(solid.bvh, box, [&](std::uint32_t u) {
      if (u <= t || !meet(box, triangle_box(mesh, u)) || is_collinear(mesh, u)) return true;
      const SelfContact contact = self_contact(mesh, t, u);
      if (contact == SelfContact::touching) touching[t] = touching[u] = true;
      return contact != SelfContact::overlapping;
    });
    if (!apart) return false;
  }
  for (const SurfacePart& part : solid.parts) {
    // One that is collinear tells nothing of its shell.
    if (is_collinear(mesh, part.triangle)) touching.assign(touching.size(), true);
    touching[part.triangle] = true;
  }
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (touching[t] && !is_collinear(mesh, t) && !is_once_beside(solid, t)) return false;
  }
  return true;
}

}  // namespace satcheck
