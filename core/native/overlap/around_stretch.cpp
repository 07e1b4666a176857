#include "overlap/around_stretch.hpp"

#include <algorithm>
#include <array>

#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/surface.hpp"

namespace satcheck {
namespace {

using Groups = std::vector<std::vector<HalfPlane>>;

int sign_of(bool positive) { return positive ? 1 : -1; }

class Turn {
 public:
  Turn(const Mesh& a, const Mesh& b, const MeetingNodes& nodes, const std::vector<HalfPlane>& half_planes)
      : meshes_{&a, &b}, nodes_(nodes), half_planes_(half_planes) {}

  std::optional<Groups> order() const {
    const auto has_edge = [](const HalfPlane& h) { return h.edge >= 0; };
    const auto on_edge = std::find_if(half_planes_.begin(), half_planes_.end(), has_edge);
    if (on_edge == half_planes_.end()) return order_at_crossing();
    const Corners t = corners(*meshes_[on_edge->mesh], on_edge->triangle);
    const Vec3 from = t[on_edge->edge], to = t[(on_edge->edge + 1) % 3];
    return on_edge->left ? order_about(from, to) : order_about(to, from);
  }

 private:
  // The order about the edge of a mesh. Each half-plane is represented by a corner of its triangle.
  std::optional<Groups> order_about(Vec3 from, Vec3 to) const {
    std::vector<Vec3> places;
    for (const HalfPlane& h : half_planes_) {
      const auto corner = corner_in(h, from, to);
      if (!corner) return std::nullopt;
      places.push_back(*corner);
    }
    Groups groups;
    for (const auto& group : groups_around(from, to, places)) {
      groups.emplace_back();
      for (const std::size_t k : group) groups.back().push_back(half_planes_[k]);
    }
    return groups;
  }

  // A corner of the triangle that lies in the open half-plane.
  std::optional<Vec3> corner_in(const HalfPlane& h, Vec3 from, Vec3 to) const {
    const Corners t = corners(*meshes_[h.mesh], h.triangle);
    if (h.edge >= 0) return t[(h.edge + 2) % 3];
    const int axis = projection_axis(t[0], t[1], t[2]);
    const int turn = orientation_2d(t[0], t[1], t[2], axis) * sign_of(h.left);
    for (const Vec3& p : t) {
      if (turn * orientation_2d(from, to, p, axis) > 0) return p;
    }
    return std::nullopt;
  }

  // The order where two triangles cross inside both.
  std::optional<Groups> order_at_crossing() const {
    std::array<const HalfPlane*, 4> at{};  // left and right of a, left and right of b
    if (half_planes_.size() != 4) return std::nullopt;
    for (const HalfPlane& h : half_planes_) at[2 * h.mesh + (h.left ? 0 : 1)] = &h;
    for (const HalfPlane* h : at) {
      if (!h) return std::nullopt;
    }
    const Corners t = corners(*meshes_[0], at[0]->triangle), u = corners(*meshes_[1], at[2]->triangle);
    const int axis = projection_axis(t[0], t[1], t[2]);
    const int turn = orientation_2d(t[0], t[1], t[2], axis);
    const ExactPoint &low = nodes_.at(half_planes_[0].low), &high = nodes_.at(half_planes_[0].high);
    for (const Vec3& p : t) {
      if (turn * orientation_2d_at(low, high, make_exact_point(p), axis) <= 0) continue;
      const bool left_in_front = orientation(u[0], u[1], u[2], p) > 0;
      const int before = left_in_front ? 0 : 1;  // which half of a comes after the left one of b
      return Groups{{*at[2]}, {*at[before]}, {*at[3]}, {*at[1 - before]}};
    }
    return std::nullopt;
  }

  const Mesh* meshes_[2];
  const MeetingNodes& nodes_;
  const std::vector<HalfPlane>& half_planes_;
};

}  // namespace

std::optional<Groups> order_around(const Mesh& a, const Mesh& b, const MeetingNodes& nodes,
                                   const std::vector<HalfPlane>& half_planes) {
  return Turn(a, b, nodes, half_planes).order();
}

}  // namespace satcheck
