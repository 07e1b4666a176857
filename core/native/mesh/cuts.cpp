#include "mesh/cuts.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/surface.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

using Signs = std::array<int, 3>;

// How an edge in the plane is used by the partners.
struct Use {
  int flat_up = 0, flat_down = 0, others = 0;
  bool front = false, back = false;  // which way the flat ones face

  bool continues() const {
    return flat_up == 1 && flat_down == 1 && others == 0 && front != back;
  }
};

class Cuts {
 public:
  Cuts(const Mesh& mesh, std::uint32_t t, const Mesh& other, Touching touching, Budget* budget)
      : t_(corners(mesh, t)),
        other_(other),
        touching_(touching),
        budget_(budget),
        axis_(projection_axis(rounded_normal(t_[0], t_[1], t_[2]))) {}

  void add(std::uint32_t partner) {
    const Triangle& corner = other_.triangles[partner];
    const Corners p = corners(other_, partner);
    Signs side;
    for (int i = 0; i < 3; ++i) side[i] = orientation(t_[0], t_[1], t_[2], p[i], budget_);
    add_edges(corner, p, side);
    const bool straddles = std::min({side[0], side[1], side[2]}) < 0 && std::max({side[0], side[1], side[2]}) > 0;
    const bool kept = touching_ == Touching::kept;
    if (straddles && (kept || classify(t_, p, budget_) == TriangleContact::crossing)) add_crossing(p, side);
    for (int i = 0; i < 3 && kept; ++i) {
      if (side[i] == 0) add_point(p[i]);
    }
  }

  std::vector<PlaneSegment> result() && {
    for (const auto& [edge, use] : edges_) {
      if (touching_ == Touching::left_out && use.continues()) continue;
      cuts_.push_back({make_exact_point(other_.vertices[edge.first]), make_exact_point(other_.vertices[edge.second])});
    }
    return std::move(cuts_);
  }

 private:
  void add_edges(const Triangle& corner, const Corners& p, const Signs& side) {
    const bool flat = side == Signs{};
    const int turn = flat ? orientation_2d(p[0], p[1], p[2], axis_) : 0;
    for (int i = 0; i < 3; ++i) {
      const int k = (i + 1) % 3;
      if (side[i] != 0 || side[k] != 0 || corner[i] == corner[k]) continue;
      Use& use = edges_[std::minmax(corner[i], corner[k])];
      if (turn == 0) {
        ++use.others;
      } else {
        ++(corner[i] < corner[k] ? use.flat_up : use.flat_down);
        (turn > 0 ? use.front : use.back) = true;
      }
    }
  }

  void add_crossing(const Corners& p, const Signs& side) {
    std::vector<ExactPoint> ends;
    for (int i = 0; i < 3; ++i) {
      const int k = (i + 1) % 3;
      if (side[i] == 0) ends.push_back(make_exact_point(p[i]));
      if (side[i] * side[k] < 0) ends.push_back(plane_meeting_point(t_[0], t_[1], t_[2], p[i], p[k]));
    }
    spend(budget_, sign_work(ends[0]) + sign_work(ends[1]));
    cuts_.push_back({ends[0], ends[1]});
  }

  // A segment from a corner of t, so that the point is on one.
  void add_point(Vec3 p) {
    cuts_.push_back({make_exact_point(t_[0] == p ? t_[1] : t_[0]), make_exact_point(p)});
  }

  Corners t_;
  const Mesh& other_;
  Touching touching_;
  Budget* budget_;
  int axis_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Use> edges_;
  std::vector<PlaneSegment> cuts_;
};

}  // namespace

std::vector<PlaneSegment> find_cuts(const Mesh& mesh, std::uint32_t t, const Mesh& other,
                                    const std::vector<std::uint32_t>& partners, Touching touching, Budget* budget) {
  Cuts cuts(mesh, t, other, touching, budget);
  for (const std::uint32_t partner : partners) cuts.add(partner);
  return std::move(cuts).result();
}

}  // namespace satcheck
