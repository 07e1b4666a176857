// The expanding polytope algorithm of epa.cpp in exact arithmetic, without tolerances. The facets that are visible from
// the new vertex, or whose plane contains it, are replaced by a fan around it. No facet of the fan has area 0: an edge
// in line with the new vertex lies between two removed facets. Rounded distances and the filter of `side` only save
// work. Exact signs decide.

#include "convex/exact_depth.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "base/rounding.hpp"
#include "convex/exact_distance.hpp"
#include "convex/minkowski.hpp"
#include "convex/shape.hpp"

namespace satcheck {
namespace {

// Measured steps of looking at a facet, of comparing two of them exactly, and of making one.
constexpr std::uint64_t kLookWork = 4, kComparisonWork = 500, kNewFacetWork = 2000;

struct Facet {
  std::uint32_t corner[3];  // counter-clockwise from outside
  DyadicVec normal;
  Dyadic height;    // normal . p on the plane
  Dyadic normal_squared, height_squared;  // the latter with the sign of the height
  Vec3 unit;        // rounded
  double distance;  // of the plane from the origin, signed, relative error within 4 roundoffs
};

class ExactPolytope {
 public:
  explicit ExactPolytope(const ExactDifference& difference) : difference_(difference) { start(); }

  // A - B spans no volume; there are no facets.
  bool is_flat() const { return facets_.empty(); }
  const Facet& nearest() const;
  bool reaches_beyond(const ExactSupport& w, const Facet& f) const { return side(w, f) > 0; }
  void expand(const ExactSupport& w);
  ExactFigure figure(const Facet& nearest) const;

 private:
  void start();
  void offer(const ExactSupport& p);
  void add(std::uint32_t p, std::uint32_t q, std::uint32_t r);
  // Sign of the height of w over the plane of f.
  int side(const ExactSupport& w, const Facet& f) const;

  const ExactDifference& difference_;
  std::vector<ExactSupport> vertices_;
  std::vector<Facet> facets_;
};

// Whether the plane of f is nearer than the plane of g, by signed distances.
bool is_nearer(const Facet& f, const Facet& g) {
  return (f.height_squared * g.normal_squared - g.height_squared * f.normal_squared).sign() < 0;
}

// The foot of the origin lies in the facet with the nearest plane. Rounded distances leave only few facets to be
// compared exactly.
const Facet& ExactPolytope::nearest() const {
  spend(difference_.budget(), kLookWork * facets_.size());
  const Facet* best = &*std::min_element(facets_.begin(), facets_.end(), [](const Facet& f, const Facet& g) {
    return f.distance < g.distance;
  });
  const double limit = best->distance + 16 * kUnitRoundoff * std::fabs(best->distance);
  for (const Facet& f : facets_) {
    if (f.distance > limit || &f == best) continue;
    spend(difference_.budget(), kComparisonWork);
    if (is_nearer(f, *best)) best = &f;
  }
  return *best;
}

// Adds the point to the first tetrahedron if it adds a dimension.
void ExactPolytope::offer(const ExactSupport& p) {
  const auto edge = [&](std::size_t i) { return vertices_[i].w - vertices_[0].w; };
  bool spans = true;
  if (!vertices_.empty()) {
    const DyadicVec e = p.w - vertices_[0].w;
    const DyadicVec across = vertices_.size() == 1 ? e : cross(edge(1), vertices_.size() == 2 ? e : edge(2));
    spans = vertices_.size() == 3 ? dot(across, e).sign() != 0
                                  : across.x.sign() != 0 || across.y.sign() != 0 || across.z.sign() != 0;
  }
  if (spans) vertices_.push_back(p);
}

void ExactPolytope::start() {
  for (Vec3 axis : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
    if (vertices_.size() < 4) offer(difference_.support(DyadicVec(axis)));
  }
  // These directions span A - B from its first vertex, whatever its shape.
  const auto corner = vertices_.front();
  const std::size_t count_a = difference_.vertices_a().size(), count = count_a + difference_.vertices_b().size();
  for (std::uint32_t i = 0; i < count && vertices_.size() < 4; ++i) {
    offer(i < count_a ? difference_.at(i, corner.b) : difference_.at(corner.a, static_cast<std::uint32_t>(i - count_a)));
  }
  if (vertices_.size() < 4) return;
  const DyadicVec& p = vertices_[0].w;
  const DyadicVec n = cross(vertices_[1].w - p, vertices_[2].w - p);
  if (dot(n, vertices_[3].w - p).sign() > 0) std::swap(vertices_[1], vertices_[2]);
  constexpr std::uint32_t corners[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  for (const auto& c : corners) add(c[0], c[1], c[2]);
}

void ExactPolytope::add(std::uint32_t p, std::uint32_t q, std::uint32_t r) {
  spend(difference_.budget(), kNewFacetWork);
  Facet f{{p, q, r}, cross(vertices_[q].w - vertices_[p].w, vertices_[r].w - vertices_[p].w), {}, {}, {}, {}, 0};
  f.height = dot(f.normal, vertices_[p].w);
  f.normal_squared = dot(f.normal, f.normal);
  f.height_squared = f.height * f.height;
  f.unit = rounded_unit(f.normal);
  if (f.height.sign() != 0) f.distance = rooted(f.height_squared, f.normal_squared).value;
  if (f.height.sign() < 0) {
    f.height_squared = -f.height_squared;
    f.distance = -f.distance;
  }
  facets_.push_back(std::move(f));
}

int ExactPolytope::side(const ExactSupport& w, const Facet& f) const {
  // 12 roundoffs of the unit normal, 1 of the vertex, 3 of the dot product and 4 of the distance, times
  // sqrt(3) for three terms up to the scale: below 48.
  const double height = dot(f.unit, w.rounded) - f.distance;
  if (std::fabs(height) > 48 * kUnitRoundoff * difference_.scale()) return height > 0 ? 1 : -1;
  return (dot(f.normal, w.w) - f.height).sign();
}

void ExactPolytope::expand(const ExactSupport& w) {
  spend(difference_.budget(), kLookWork * facets_.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::erase_if(facets_, [&](const Facet& f) {
    if (side(w, f) < 0) return false;
    for (int i = 0; i < 3; ++i) edges.emplace(f.corner[i], f.corner[(i + 1) % 3]);
    return true;
  });
  const auto apex = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back(w);
  for (const auto& [tail, head] : edges) {
    if (!edges.contains({head, tail})) add(tail, head, apex);
  }
}

ExactFigure ExactPolytope::figure(const Facet& nearest) const {
  ExactFigure figure = rooted(nearest.height * nearest.height, nearest.normal_squared);
  // The normal is rounded, so the translation along it has to be a little longer. `upper` is long enough.
  figure.normal = nearest.unit;
  const DyadicVec normal(figure.normal);
  const double along = rounded_ratio(dot(normal, difference_.support(normal).w), dot(normal, normal));
  figure.upper = std::fmax(figure.upper, std::nextafter(along * (1 + 4 * kUnitRoundoff), INFINITY));
  // The foot of the origin lies in the facet, or in another triangle of its plane.
  for (const Facet& f : facets_) {
    const std::vector<ExactSupport> corners{vertices_[f.corner[0]], vertices_[f.corner[1]], vertices_[f.corner[2]]};
    if (!std::all_of(corners.begin(), corners.end(), [&](const ExactSupport& c) { return side(c, nearest) == 0; })) {
      continue;
    }
    const DyadicVec &p = corners[0].w, &q = corners[1].w, &r = corners[2].w;
    const std::vector<Dyadic> weights{dot(f.normal, cross(q, r)), dot(f.normal, cross(r, p)),
                                      dot(f.normal, cross(p, q))};
    if (std::any_of(weights.begin(), weights.end(), [](const Dyadic& w) { return w.sign() < 0; })) continue;
    place_witnesses(figure, difference_, corners, weights);
    break;
  }
  return figure;
}

// The sign of height - length |normal|; the length is not negative.
int compare(const Dyadic& height, const DyadicVec& normal, const Dyadic& length) {
  if (height.sign() < 0 || length.sign() == 0) return height.sign();
  return (height * height - length * length * dot(normal, normal)).sign();
}

}  // namespace

ExactFigure exact_depth(const ExactDifference& difference) {
  ExactPolytope polytope(difference);
  for (;;) {
    const Facet& nearest = polytope.nearest();
    const ExactSupport w = difference.support(nearest.normal);
    if (!polytope.reaches_beyond(w, nearest)) return polytope.figure(nearest);
    polytope.expand(w);
  }
}

int compare_depth(const ExactDifference& difference, const Dyadic& length) {
  ExactPolytope polytope(difference);
  if (polytope.is_flat()) return length.sign() > 0 ? -1 : -compare_distance(difference, length);
  for (;;) {
    const Facet& nearest = polytope.nearest();
    if (compare(nearest.height, nearest.normal, length) > 0) return 1;
    const ExactSupport w = difference.support(nearest.normal);
    const int reach = compare(dot(nearest.normal, w.w), nearest.normal, length);
    if (reach < 0 || !polytope.reaches_beyond(w, nearest)) return reach;
    polytope.expand(w);
  }
}

// Each shape is a core with a ball around it. The distance of the cores is compared with the length plus both radii.
std::optional<int> compare_signed_distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                                           double length) {
  if (MinkowskiDifference(a, pose_a, b, pose_b).curved) return std::nullopt;
  Budget budget = Budget::that_stops(kMostExactWork);
  const ExactDifference difference(world_points(a, pose_a), world_points(b, pose_b), &budget);
  const Dyadic of_cores = Dyadic(length) + Dyadic(a.margin) + Dyadic(b.margin);
  try {
    return of_cores.sign() > 0 ? compare_distance(difference, of_cores) : -compare_depth(difference, -of_cores);
  } catch (const BudgetSpent&) {
    return std::nullopt;
  }
}

}  // namespace satcheck
