// Method: C. Bradford Barber, David P. Dobkin, Hannu Huhdanpaa, "The Quickhull Algorithm for
// Convex Hulls" (1996). Where we deviate: "above a facet" is the exact sign of an orientation, not
// a distance beyond a thickness; points in the plane of a facet are not above it. Then the visible
// facets always form a disk and no new facet is degenerate: an eye point collinear with a horizon
// edge would lie in the plane of the visible facet at that edge.
#include "convex/quickhull.hpp"

#include <limits>

#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// Measured steps: of making a facet, including its faces and edges in the hull, and of testing a point against a facet.
constexpr std::uint64_t kFacetWork = 300, kHeightWork = 4;

// The error bound of the 3x3 determinant, derived in predicates.cpp, with one more u because the
// permanent is replaced by a bound that holds for all points of the bounding box.
constexpr double kPlaneBound = 10 * (std::numeric_limits<double>::epsilon() / 2);

struct HullFacet {
  Triangle corner;
  std::array<std::uint32_t, 3> neighbour;  // across corner[i] -> corner[i + 1]
  Vec3 anchor, normal;                     // rounded plane, for the filter
  double bound = 0;                        // |rounded height - exact| for any point of the box
  std::uint32_t first_above = kNoIndex;  // conflict list: points strictly above
  std::uint32_t highest = kNoIndex;
  double highest_height = 0;
  bool alive = true;
  bool visible = false;
};

struct HorizonEdge {
  std::uint32_t tail, head;
  std::uint32_t behind;  // the facet on the far side, which is kept
};

class Builder {
 public:
  Builder(const std::vector<Vec3>& points, Budget* budget)
      : points_(points), budget_(budget), next_above_(points.size(), kNoIndex), facet_from_(points.size(), kNoIndex) {
    extent_ = bounds_of(points).size();
  }

  std::vector<Triangle> build(std::array<std::uint32_t, 4> simplex) {
    start(simplex);
    pay();
    for (std::uint32_t f = 0; f < facets_.size(); ++f) {
      // Facets are only appended, so one pass sees every conflict list.
      if (!facets_[f].alive || facets_[f].first_above == kNoIndex) continue;
      add_point(f);
      pay();
    }
    std::vector<Triangle> triangles;
    for (const HullFacet& facet : facets_) {
      if (facet.alive) triangles.push_back(facet.corner);
    }
    return triangles;
  }

 private:
  std::uint32_t add_facet(Triangle corner) {
    HullFacet facet;
    facet.corner = corner;
    facet.anchor = points_[corner[0]];
    const Vec3 u = points_[corner[1]] - facet.anchor, v = points_[corner[2]] - facet.anchor;
    facet.normal = cross(u, v);
    facet.bound =
        kPlaneBound * ((std::fabs(u.y * v.z) + std::fabs(u.z * v.y)) * extent_.x +
                       (std::fabs(u.z * v.x) + std::fabs(u.x * v.z)) * extent_.y +
                       (std::fabs(u.x * v.y) + std::fabs(u.y * v.x)) * extent_.z) + kUnderflow;
    facets_.push_back(facet);
    return static_cast<std::uint32_t>(facets_.size() - 1);
  }

  double rounded_height(const HullFacet& facet, std::uint32_t point) const {
    return dot(facet.normal, points_[point] - facet.anchor);
  }

  bool is_above(const HullFacet& facet, std::uint32_t point, double height) const {
    if (height > facet.bound) return true;
    if (height < -facet.bound) return false;
    const Triangle& t = facet.corner;
    return orientation(points_[t[0]], points_[t[1]], points_[t[2]], points_[point], budget_) > 0;
  }

  bool assign(std::uint32_t f, std::uint32_t point) {
    ++heights_;
    HullFacet& facet = facets_[f];
    const double height = rounded_height(facet, point);
    if (!is_above(facet, point, height)) return false;
    if (facet.highest == kNoIndex || height > facet.highest_height) {
      facet.highest = point;
      facet.highest_height = height;
    }
    next_above_[point] = facet.first_above;
    facet.first_above = point;
    return true;
  }

  void start(std::array<std::uint32_t, 4> s) {
    if (orientation(points_[s[0]], points_[s[1]], points_[s[2]], points_[s[3]]) > 0) {
      std::swap(s[1], s[2]);
    }
    // s[3] now lies below s[0], s[1], s[2]; facet i + 1 lies across the base edge i.
    facets_.reserve(64);
    add_facet({s[0], s[1], s[2]});
    add_facet({s[1], s[0], s[3]});
    add_facet({s[2], s[1], s[3]});
    add_facet({s[0], s[2], s[3]});
    facets_[0].neighbour = {1, 2, 3};
    facets_[1].neighbour = {0, 3, 2};
    facets_[2].neighbour = {0, 1, 3};
    facets_[3].neighbour = {0, 2, 1};
    for (std::uint32_t p = 0; p < points_.size(); ++p) {
      if (p == s[0] || p == s[1] || p == s[2] || p == s[3]) continue;
      for (std::uint32_t f = 0; f < 4; ++f) {
        if (assign(f, p)) break;
      }
    }
  }

  // The facets that see `eye`, grown from one of them, and the horizon around them.
  void find_visible(std::uint32_t seed, std::uint32_t eye) {
    visible_.assign(1, seed);
    horizon_.clear();
    facets_[seed].visible = true;
    for (std::size_t i = 0; i < visible_.size(); ++i) {
      const std::uint32_t f = visible_[i];
      for (int side = 0; side < 3; ++side) {
        const std::uint32_t g = facets_[f].neighbour[side];
        if (facets_[g].visible) continue;
        if (is_above(facets_[g], eye, rounded_height(facets_[g], eye))) {
          facets_[g].visible = true;
          visible_.push_back(g);
        }
      }
    }
    for (const std::uint32_t f : visible_) {
      const HullFacet& facet = facets_[f];
      for (int side = 0; side < 3; ++side) {
        if (facets_[facet.neighbour[side]].visible) continue;
        horizon_.push_back(
            {facet.corner[side], facet.corner[(side + 1) % 3], facet.neighbour[side]});
      }
    }
  }

  void add_cone(std::uint32_t eye) {
    const auto first = static_cast<std::uint32_t>(facets_.size());
    for (const HorizonEdge& edge : horizon_) {
      const std::uint32_t f = add_facet({edge.tail, edge.head, eye});
      facets_[f].neighbour[0] = edge.behind;
      facet_from_[edge.tail] = f;
      HullFacet& behind = facets_[edge.behind];
      for (int side = 0; side < 3; ++side) {
        if (behind.corner[side] == edge.head) behind.neighbour[side] = f;
      }
    }
    for (std::uint32_t f = first; f < facets_.size(); ++f) {
      const std::uint32_t next = facet_from_[facets_[f].corner[1]];
      facets_[f].neighbour[1] = next;
      facets_[next].neighbour[2] = f;
    }
  }

  void add_point(std::uint32_t seed) {
    const std::uint32_t eye = facets_[seed].highest;
    find_visible(seed, eye);
    const auto first_new = static_cast<std::uint32_t>(facets_.size());
    add_cone(eye);
    for (const std::uint32_t f : visible_) {
      facets_[f].alive = false;
      std::uint32_t next = kNoIndex;
      for (std::uint32_t p = facets_[f].first_above; p != kNoIndex; p = next) {
        next = next_above_[p];
        if (p == eye) continue;
        for (std::uint32_t g = first_new; g < facets_.size(); ++g) {
          if (assign(g, p)) break;
        }
      }
    }
  }

  // For what was made since the last payment.
  void pay() {
    spend(budget_, kFacetWork * (facets_.size() - paid_facets_) + kHeightWork * heights_);
    paid_facets_ = facets_.size();
    heights_ = 0;
  }

  const std::vector<Vec3>& points_;
  Budget* budget_;
  std::vector<HullFacet> facets_;
  std::vector<std::uint32_t> next_above_;  // links of the conflict lists
  std::vector<std::uint32_t> facet_from_;  // new facet whose horizon edge starts at a point
  std::vector<std::uint32_t> visible_;
  std::vector<HorizonEdge> horizon_;
  Vec3 extent_;
  std::size_t paid_facets_ = 0;
  std::uint64_t heights_ = 0;
};

}  // namespace

std::vector<Triangle> quickhull(const std::vector<Vec3>& points,
                                std::array<std::uint32_t, 4> simplex, Budget* budget) {
  return Builder(points, budget).build(simplex);
}

}  // namespace satcheck
