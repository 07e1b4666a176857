// If no other triangle meets an edge of two triangles, the winding numbers beside both triangles are the same, because
// nothing else is near a generic point of that edge. One piece therefore represents all triangles that are connected
// through such edges.
#include "mesh/self_contact.hpp"

#include <algorithm>

#include "base/edge_table.hpp"
#include "exact/exact_point.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

// Measured steps of two triangles of a mesh whose boxes meet.
constexpr std::uint64_t kPartnerWork = 120;

// The corners of t in an order that starts with those it shares with u.
struct SharedFirst {
  Triangle corner;
  int shared = 0;

  SharedFirst(const Triangle& t, const Triangle& u) {
    int others = 0;
    for (const std::uint32_t v : t) {
      const bool is_shared = v == u[0] || v == u[1] || v == u[2];
      corner[is_shared ? shared++ : 2 - others++] = v;
    }
  }
};

}  // namespace

MeshTriangle::MeshTriangle(const Mesh& mesh, std::uint32_t t, Budget* budget)
    : mesh_(&mesh), budget_(budget), t_(mesh.triangles[t]), c_(corners(mesh, t)), plane_(c_[0], c_[1], c_[2]),
      axis_(projection_axis(c_[0], c_[1], c_[2], budget)), turn_(turn(c_[0], c_[1], c_[2])) {}

bool MeshTriangle::has_more_in_common_with(std::uint32_t other) const {
  const Triangle& u = mesh_->triangles[other];
  const SharedFirst mine(t_, u), theirs(u, t_);
  const Triangle &i = mine.corner, &k = theirs.corner;
  switch (theirs.shared) {
    case 0: {
      const Corners c = corners(*mesh_, other);
      return !lies_beyond(c) && classify(plane_, c, budget_) != TriangleContact::disjoint;
    }
    case 1: return goes_on_from(at(i[0]), at(i[1]), at(i[2]), at(k[1]), at(k[2]));
    case 2: return folds_onto(at(i[0]), at(i[1]), at(i[2]), at(k[2]));
    default: return true;
  }
}

// Whether the corner s of a triangle across the edge p q is in the plane, on the side of r. Coplanar neighbours usually
// lie on both sides of the edge, which is a quick test.
bool MeshTriangle::folds_onto(Vec3 p, Vec3 q, Vec3 r, Vec3 s) const {
  return turn(p, q, r) == turn(p, q, s) && plane_.side(s, budget_) == 0;
}

// This triangle is p, q, r, and the other one is p, s, t.
bool MeshTriangle::goes_on_from(Vec3 p, Vec3 q, Vec3 r, Vec3 s, Vec3 t) const {
  if (parts(p, q, r, s, t) || parts(p, r, q, s, t) || parts(p, s, t, q, r) || parts(p, t, s, q, r)) return false;
  if (plane_.side(s, budget_) * plane_.side(t, budget_) > 0) return false;
  // Their common part is convex. If it goes beyond the corner p, it ends on an edge opposite to p.
  return segment_meets_triangle(q, r, {p, s, t}, budget_) || segment_meets_triangle(s, t, c_, budget_);
}

// Whether the line p q, seen along the axis, has r on one side, and s and t on the other side, or on it but not on the
// ray from p to q. Then p is all that the triangles p q r and p s t have in common.
bool MeshTriangle::parts(Vec3 p, Vec3 q, Vec3 r, Vec3 s, Vec3 t) const {
  const int side = turn(p, q, r);
  const auto is_beyond = [&](Vec3 of) {
    const int turned = turn(p, q, of);
    const auto [i, j] = plane_axes(axis_);
    const int along = p[i] != q[i] ? i : j;
    return turned != 0 ? turned != side : of[along] == p[along] || (of[along] < p[along]) != (q[along] < p[along]);
  };
  return side != 0 && is_beyond(s) && is_beyond(t);
}

// Whether the line along an edge of this triangle, seen along the axis, has all of the other one strictly beyond it.
bool MeshTriangle::lies_beyond(const Corners& other) const {
  const auto parts_at = [&](int i) {
    return std::all_of(other.begin(), other.end(), [&](Vec3 p) { return turn_ * turn(c_[i], c_[(i + 1) % 3], p) < 0; });
  };
  return parts_at(0) || parts_at(1) || parts_at(2);
}

int MeshTriangle::turn(Vec3 p, Vec3 q, Vec3 r) const { return orientation_2d(p, q, r, axis_, budget_); }

bool has_irregular_partners(const Surface& surface, std::uint32_t t, Budget* budget) {
  const Mesh& mesh = surface.mesh;
  const MeshTriangle triangle(mesh, t, budget);
  return !visit_box(surface.bvh, mesh, triangle_box(mesh, t), [&](std::uint32_t u) {
    spend(budget, kPartnerWork);
    return u == t || is_collinear(corners(mesh, u), budget) || !triangle.has_more_in_common_with(u);
  }, budget);
}

void visit_uniform_parts(const std::vector<const Surface*>& surfaces, const std::function<bool(std::uint32_t)>& wanted,
                         const std::function<bool(std::uint32_t)>& plain,
                         const std::function<bool(const PlaneCells&)>& patch, Budget* budget) {
  const Surface& surface = *surfaces[0];
  const Mesh& mesh = surface.mesh;
  const std::vector<std::uint32_t> twins = EdgeTable(mesh.vertices.size(), mesh.triangles).twins();
  std::vector<bool> done(mesh.triangles.size(), false);
  for (std::uint32_t first = 0; first < mesh.triangles.size(); ++first) {
    if (done[first] || !wanted(first) || is_collinear(corners(mesh, first), budget)) continue;
    if (has_irregular_partners(surface, first, budget)) {
      const PlaneCells cells(surfaces, {0, first}, SinglePoints::left_out, budget);
      for (const PatchTriangle& member : cells.members()) {
        if (member.surface == 0) done[member.triangle] = true;
      }
      if (!patch(cells)) return;
      continue;
    }
    if (!plain(first)) return;
    done[first] = true;
    std::vector<std::uint32_t> queue{first};
    while (!queue.empty()) {
      const std::uint32_t t = queue.back();
      queue.pop_back();
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t u = twins[h] / 3;
        if (twins[h] == kNoIndex || done[u] || !wanted(u) || is_collinear(corners(mesh, u), budget)) continue;
        if (has_irregular_partners(surface, u, budget)) continue;
        done[u] = true;
        queue.push_back(u);
      }
    }
  }
}

}  // namespace satcheck
