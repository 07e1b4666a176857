// Method: Robin Deits, Russ Tedrake, "Computing Large Convex Regions of Obstacle-Free Space Through
// Semidefinite Programming" (2015): cut space by a plane at the nearest obstacle, and continue with the obstacles that
// remain. Obstacles are the triangles of the surface, visited nearest first through its tree. Where we deviate: the
// seed stays inside, and the metric comes from the spread of an earlier region's vertices. A curved surface would need
// a plane for every triangle. Instead a plane is moved inward a little, less the nearer it is to the seed.
//
// Proof: every triangle lies beyond one of the planes, and every vertex of the result lies on the inner side of all
// planes. The distance between them exceeds the rounding of both tests.
#include "convex/convex_hull.hpp"
#include "depth/inner_region.hpp"

#include <algorithm>
#include <queue>
#include <utility>

#include "base/numeric_range.hpp"
#include "base/rounding.hpp"
#include "exact/triangle_distance.hpp"

namespace satcheck {
namespace {

// Measured steps of visiting a box or a triangle, and of testing it against a plane.
constexpr std::uint64_t kVisitWork = 60, kPlaneTestWork = 3;

constexpr std::size_t kMaxCuts = 74;  // planes beside the first ones
// A plane may move inward by this share of its distance from the seed. The share doubles with the number of planes.
constexpr double kGiveWay = 1.0 / 16, kMostWay = 0.5;
constexpr std::size_t kCutsToDoubleIt = 12;
// Rounding of two plane tests, as a multiple of the largest coordinate: along a unit normal, a corner's
// differences from the seed, products and sums are off by less than 14 roundoffs, a box's by less than 24.
constexpr double kPlaneError = 64 * kUnitRoundoff;

// Least variance of a metric's ellipsoid as a share of their sum.
constexpr double kLeastVariance = 1e-6;

// Tiny coordinates that are left by rounding are out of the range of exact predicates.
constexpr double kDust = 1e-70;

double without_dust(double x) { return std::fabs(x) < kDust ? 0.0 : x; }
Vec3 without_dust(Vec3 v) { return {without_dust(v.x), without_dust(v.y), without_dust(v.z)}; }

struct Plane {
  Vec3 normal;     // unit
  double offset;   // of the plane from the seed, > 0
  double nominal;  // the offset before it was moved inward
};

struct Candidate {
  double distance_squared;
  std::uint32_t index;
  bool triangle;
};

struct Farther {
  bool operator()(const Candidate& a, const Candidate& b) const {
    if (a.distance_squared != b.distance_squared) return a.distance_squared > b.distance_squared;
    if (a.triangle != b.triangle) return a.triangle < b.triangle;
    return a.index > b.index;
  }
};

class Growth {
 public:
  Growth(const Surface& solid, Vec3 seed, const Metric& metric, Budget* budget, const Polytope* within)
      : solid_(solid), seed_(seed), metric_(metric), budget_(budget) {
    Aabb box = solid.bvh.nodes[0].box;
    if (within) {
      box.include(bounds_of(within->vertices));
      for (std::size_t f = 0; f < within->face_count(); ++f) {
        const Vec3 normal = within->face_normal[f], corner = within->vertices[within->face_vertex[within->face_offset[f]]];
        add_plane(normal, dot(normal, corner - seed));
      }
    }
    pad_ = kPlaneError * box.largest_coordinate();
    for (int axis = 0; axis < 3 && !within; ++axis) {
      const Vec3 unit{axis == 0 ? 1.0 : 0, axis == 1 ? 1.0 : 0, axis == 2 ? 1.0 : 0};
      add_plane(unit, (box.max - seed)[axis]);
      add_plane(-unit, (seed - box.min)[axis]);
    }
    first_planes_ = planes_.size();
  }

  std::optional<InnerRegion> run() {
    push_node(0);
    while (!queue_.empty()) {
      const Candidate next = queue_.top();
      queue_.pop();
      spend(budget_, kVisitWork + kPlaneTestWork * planes_.size());
      if (next.triangle) {
        if (!cut_off(corners(solid_.mesh, next.index))) return std::nullopt;
        continue;
      }
      const BvhNode& node = solid_.bvh.nodes[next.index];
      if (is_beyond(node.box)) continue;
      if (!node.is_leaf()) {
        push_node(node.first);
        push_node(node.first + 1);
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) push_triangle(solid_.bvh.order[i]);
    }
    return polytope();
  }

 private:
  void add_plane(Vec3 normal, double offset) { planes_.push_back({normal, offset, offset}); }

  void push_node(std::uint32_t index) {
    const Aabb& box = solid_.bvh.nodes[index].box;
    if (is_beyond(box)) return;
    // The box of the node in the metric's frame contains the image of the node.
    const Vec3 centre = box.centre() - seed_, half = box.size() * 0.5;
    double squared = 0;
    for (const Vec3& row : metric_.row) {
      const double gap = std::fabs(dot(row, centre)) - reach_along(row, half);
      if (gap > 0) squared += gap * gap;
    }
    queue_.push({squared, index, false});
  }

  void push_triangle(std::uint32_t index) {
    const Corners c = corners(solid_.mesh, index);
    if (is_beyond(c)) return;
    const Corners local = in_metric(c);
    queue_.push({norm_squared(nearest_on_triangle({}, local)), index, true});
  }

  Corners in_metric(Corners c) const {
    for (Vec3& p : c) p = metric_ * (p - seed_);
    return c;
  }

  // Whether a plane keeps the obstacle off the seed. The plane of the obstacle before is tried first: near obstacles
  // often share one.
  template <typename IsBeyond>
  bool is_beyond_any(IsBeyond is_beyond) {
    if (is_beyond(planes_[last_])) return true;
    const auto plane = std::find_if(planes_.begin(), planes_.end(), is_beyond);
    if (plane == planes_.end()) return false;
    last_ = static_cast<std::size_t>(plane - planes_.begin());
    return true;
  }

  bool is_beyond(const Aabb& box) {
    const Vec3 centre = box.centre() - seed_, half = box.size() * 0.5;
    return is_beyond_any([&](const Plane& p) { return dot(p.normal, centre) - reach_along(p.normal, half) >= p.offset; });
  }

  bool is_beyond(const Corners& c) {
    return is_beyond_any([&](const Plane& p) { return least_along(p.normal, c) >= p.offset; });
  }

  double least_along(Vec3 normal, const Corners& c) const {
    return smaller(dot(normal, c[0] - seed_), smaller(dot(normal, c[1] - seed_), dot(normal, c[2] - seed_)));
  }

  // Moves or adds a plane so that the triangle lies beyond it. False: the seed would not stay inside.
  bool cut_off(const Corners& c) {
    if (is_beyond(c)) return true;
    Plane* closest = nullptr;
    double closest_share = -INFINITY, closest_offset = 0;
    for (Plane& p : planes_) {
      const double least = least_along(p.normal, c);
      const double share = least / p.nominal;
      if (share > closest_share) {
        closest_share = share;
        closest_offset = least;
        closest = &p;
      }
    }
    const std::size_t cuts = planes_.size() - first_planes_;
    const double give_way = std::fmin(std::ldexp(kGiveWay, static_cast<int>(cuts / kCutsToDoubleIt)), kMostWay);
    if (closest_share >= 1 - give_way && closest_offset > 2 * pad_) {
      closest->offset = closest_offset;
      return true;
    }
    const Vec3 nearest = nearest_on_triangle({}, in_metric(c));
    const Vec3 across = transpose_times(metric_, nearest);
    const double length = norm(across);
    if (!(length > 0)) return false;
    const Vec3 normal = without_dust(across * (1 / length));
    const double offset = least_along(normal, c);
    if (!(offset > 2 * pad_) || cuts >= kMaxCuts) return false;
    add_plane(normal, offset);
    return true;
  }

  // The corners of the cell of planes about the seed, as the facets of the hull of the dual points.
  std::optional<InnerRegion> polytope() const {
    std::vector<Vec3> dual;
    double largest = 0;
    for (const Plane& p : planes_) {
      if (!(p.offset > 2 * pad_)) return std::nullopt;
      largest = std::fmax(largest, p.offset);
    }
    // A power of two, so that sizes stay in range and a scale by a power of two has no effect.
    const double unit = std::ldexp(1.0, std::ilogb(largest));
    for (const Plane& p : planes_) dual.push_back(p.normal * (unit / (p.offset - 2 * pad_)));
    const Polytope hull = convex_hull(dual, budget_);
    if (hull.dimension != 3) return std::nullopt;
    std::vector<Vec3> corner;
    for (std::size_t f = 0; f < hull.face_count(); ++f) {
      const Vec3 n = hull.face_normal[f];
      const double height = dot(n, hull.vertices[hull.face_vertex[hull.face_offset[f]]]);
      if (!(height > 0)) return std::nullopt;
      const Vec3 p = without_dust(seed_ + n * (unit / height));
      if (is_on_this_side(p)) corner.push_back(p);
    }
    if (corner.size() < 4 || !are_in_range(corner)) return std::nullopt;
    InnerRegion result{std::move(corner), {}, {}};
    for (const Plane& p : planes_) result.normals.push_back(p.normal);
    result.box = bounds_of(result.vertices);
    return result;
  }

  bool is_on_this_side(Vec3 p) const {
    return std::all_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
      return dot(plane.normal, p - seed_) <= plane.offset - pad_;
    });
  }

  const Surface& solid_;
  Vec3 seed_;
  Metric metric_;
  Budget* budget_;
  double pad_ = 0;
  std::vector<Plane> planes_;
  std::size_t first_planes_ = 0;  // of the box, or of the solid around the region
  std::size_t last_ = 0;  // the plane that the last obstacle lies beyond
  std::priority_queue<Candidate, std::vector<Candidate>, Farther> queue_;
};

}  // namespace

std::optional<InnerRegion> grow_inner_region(const Surface& solid, Vec3 seed, const Metric& metric, Budget* budget,
                                             const Polytope* within) {
  if (!solid.solid || winding_number(solid, seed, budget).value_or(0) == 0) return std::nullopt;
  return Growth(solid, seed, metric, budget, within).run();
}

Metric metric_of(const std::vector<Vec3>& points) {
  // Inverse square root of the covariance by its Cholesky factor: |L^-1 x| is the same length.
  Vec3 mean;
  for (const Vec3& p : points) mean = mean + p;
  mean = mean * (1.0 / static_cast<double>(points.size()));
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (const Vec3& v : points) {
    const Vec3 d = v - mean;
    xx += d.x * d.x;
    xy += d.x * d.y;
    xz += d.x * d.z;
    yy += d.y * d.y;
    yz += d.y * d.z;
    zz += d.z * d.z;
  }
  const double least = kLeastVariance * (xx + yy + zz);
  const double a = std::sqrt(std::fmax(xx, least)), b = xy / a, c = xz / a;
  const double d = std::sqrt(std::fmax(yy - b * b, least)), e = (yz - b * c) / d;
  const double f = std::sqrt(std::fmax(zz - c * c - e * e, least));
  Metric m;
  m.row[0] = {1 / a, 0, 0};
  m.row[1] = {-b / (a * d), 1 / d, 0};
  m.row[2] = {(b * e - c * d) / (a * d * f), -e / (d * f), 1 / f};
  return m;
}

}  // namespace satcheck
