// Beside two triangles at an edge that no other triangle meets the winding numbers are the same: around
// a generic point of that edge there is nothing else. So one piece stands for all triangles that are
// connected through such edges.
#include "mesh/self_contact.hpp"

#include <algorithm>

#include "base/edge_table.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/cuts.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

bool is_collinear(const Mesh& mesh, std::uint32_t t) {
  const Corners c = corners(mesh, t);
  return collinear(c[0], c[1], c[2]);
}

// The corners of t in an order that starts with those it shares with u.
Triangle shared_first(const Triangle& t, const Triangle& u, int& shared) {
  Triangle result = t;
  const auto is_shared = [&](std::uint32_t v) { return std::find(u.begin(), u.end(), v) != u.end(); };
  shared = static_cast<int>(std::stable_partition(result.begin(), result.end(), is_shared) - result.begin());
  return result;
}

bool has_more_in_common(const Mesh& mesh, std::uint32_t t, std::uint32_t u) {
  int shared = 0;
  const Triangle i = shared_first(mesh.triangles[t], mesh.triangles[u], shared);
  const Triangle k = shared_first(mesh.triangles[u], mesh.triangles[t], shared);
  const Corners ct = corners(mesh, t), cu = corners(mesh, u);
  if (shared == 0) return classify(ct, cu) != TriangleContact::disjoint;
  if (shared == 3) return true;
  const auto at = [&](std::uint32_t v) { return mesh.vertices[v]; };
  const int last = orientation(ct[0], ct[1], ct[2], at(k[2]));
  if (shared == 2) {
    if (last != 0) return false;
    const int axis = projection_axis(rounded_normal(ct[0], ct[1], ct[2]));
    return orientation_2d(at(i[0]), at(i[1]), at(i[2]), axis) == orientation_2d(at(i[0]), at(i[1]), at(k[2]), axis);
  }
  if (last * orientation(ct[0], ct[1], ct[2], at(k[1])) > 0) return false;
  // What they have in common is convex: beyond the corner it ends on an edge across from it.
  return segment_meets_triangle(at(i[1]), at(i[2]), cu) || segment_meets_triangle(at(k[1]), at(k[2]), ct);
}

// Across each edge of a triangle the one neighbour there, if there is exactly one.
class Neighbours {
 public:
  explicit Neighbours(const Mesh& mesh) : across_(mesh.triangles.size() * 3, kNone) {
    const EdgeTable edges(mesh.vertices.size(), mesh.triangles);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto h = edges.half_edges(e);
      if (h.size() != 2) continue;
      across_[h[0]] = h[1] / 3;
      across_[h[1]] = h[0] / 3;
    }
  }

  template <class Visit>
  void visit(std::uint32_t t, Visit visit) const {
    for (int i = 0; i < 3; ++i) {
      if (across_[3 * t + i] != kNone) visit(across_[3 * t + i]);
    }
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::vector<std::uint32_t> across_;
};

}  // namespace

std::vector<std::uint32_t> irregular_partners(const Surface& surface, std::uint32_t t) {
  const Mesh& mesh = surface.mesh;
  const Aabb box = triangle_box(mesh, t);
  std::vector<std::uint32_t> partners;
  visit_box(surface.bvh, mesh, box, [&](std::uint32_t u) {
    if (u != t && meet(box, triangle_box(mesh, u)) && !is_collinear(mesh, u) && has_more_in_common(mesh, t, u)) {
      partners.push_back(u);
    }
    return true;
  });
  return partners;
}

void visit_uniform_pieces(const Surface& surface, const std::function<bool(std::uint32_t)>& wanted,
                          const std::function<bool(std::uint32_t, const Piece&, std::size_t)>& visit) {
  const Mesh& mesh = surface.mesh;
  const Neighbours neighbours(mesh);
  std::vector<bool> done(mesh.triangles.size(), false);
  for (std::uint32_t first = 0; first < mesh.triangles.size(); ++first) {
    if (done[first] || !wanted(first) || is_collinear(mesh, first)) continue;
    const auto partners = irregular_partners(surface, first);
    const auto cuts = find_cuts(mesh, first, mesh, partners, Touching::left_out);
    const bool goes_on = visit_pieces(corners(mesh, first), cuts, Touching::left_out,
                                      [&](const Piece& piece) { return visit(first, piece, partners.size()); });
    if (!goes_on) return;
    done[first] = true;
    if (!partners.empty()) continue;
    std::vector<std::uint32_t> queue{first};
    while (!queue.empty()) {
      const std::uint32_t t = queue.back();
      queue.pop_back();
      neighbours.visit(t, [&](std::uint32_t u) {
        if (done[u] || !wanted(u) || is_collinear(mesh, u) || !irregular_partners(surface, u).empty()) return;
        done[u] = true;
        queue.push_back(u);
      });
    }
  }
}

}  // namespace satcheck
