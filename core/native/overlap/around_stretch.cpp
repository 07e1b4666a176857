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
    struct Place {
      int quarter;
      Vec3 corner;
      HalfPlane half_plane;
    };
    std::vector<Place> places;
    for (const HalfPlane& h : half_planes_) {
      const auto corner = corner_in(h, from, to);
      if (!corner) return std::nullopt;
      const Vec3 first = places.empty() ? *corner : places[0].corner;
      places.push_back({quarter(from, to, first, *corner), *corner, h});
    }
    std::stable_sort(places.begin(), places.end(), [&](const Place& p, const Place& q) {
      if (p.quarter != q.quarter) return p.quarter < q.quarter;
      return p.quarter % 2 == 1 && orientation(from, to, p.corner, q.corner) > 0;
    });
    Groups groups;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto coincides_with = [&](const Place& p) {
        return p.quarter == places[k].quarter && orientation(from, to, p.corner, places[k].corner) == 0;
      };
      if (k == 0 || !coincides_with(places[k - 1])) groups.emplace_back();
      groups.back().push_back(places[k].half_plane);
    }
    return groups;
  }

  // 0: in the half-plane of `first`, 2: opposite it; 1 and 3: before and behind that.
  static int quarter(Vec3 from, Vec3 to, Vec3 first, Vec3 corner) {
    const int turn = orientation(from, to, first, corner);
    if (turn != 0) return turn > 0 ? 1 : 3;
    for (int axis = 0; axis < 3; ++axis) {
      const int side = orientation_2d(from, to, first, axis);
      if (side != 0) return side == orientation_2d(from, to, corner, axis) ? 0 : 2;
    }
    return 0;
  }

  // A corner of the triangle that lies in the open half-plane.
  std::optional<Vec3> corner_in(const HalfPlane& h, Vec3 from, Vec3 to) const {
    const Corners t = corners(*meshes_[h.mesh], h.triangle);
    if (h.edge >= 0) return t[(h.edge + 2) % 3];
    const int axis = projection_axis(rounded_normal(t[0], t[1], t[2]));
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
    const int axis = projection_axis(rounded_normal(t[0], t[1], t[2]));
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
