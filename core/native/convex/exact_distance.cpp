// P. Wolfe, "Finding the Nearest Point in a Polytope" (1976), in exact arithmetic. Like GJK it comes nearer with every
// support point. It ends without a tolerance, when a support point is no farther along the direction. The nearest point
// of a simplex is found by its optimality: it is a point of an affine hull with positive weights, and no other vertex
// improves it.

#include "convex/exact_distance.hpp"

#include <algorithm>
#include <optional>

#include "base/rounding.hpp"
#include "exact/exact_point.hpp"

namespace satcheck {
namespace {

// Measured steps of a vertex in a search for the farthest one, and of one that is compared exactly.
constexpr std::uint64_t kVertexWork = 3, kComparedWork = 150;

Dyadic magnitude(const Dyadic& value) { return value.sign() < 0 ? -value : value; }

// The point (sum of weight[i] carrier[i]) / sum, the weights positive.
struct Nearest {
  std::vector<ExactSupport> carriers;
  std::vector<Dyadic> weights;
  DyadicVec point;  // times `sum`
  Dyadic sum;
};

// Weights, not normalised, of the origin's foot on the affine hull of one to three points.
std::vector<Dyadic> weights_of(const std::vector<ExactSupport>& carriers) {
  const DyadicVec& p = carriers[0].w;
  if (carriers.size() == 1) return {Dyadic(1)};
  const DyadicVec& q = carriers[1].w;
  if (carriers.size() == 2) return {dot(q, q - p), -dot(p, q - p)};
  const DyadicVec& r = carriers[2].w;
  const DyadicVec n = cross(q - p, r - p);
  return {dot(n, cross(q, r)), dot(n, cross(r, p)), dot(n, cross(p, q))};
}

// The foot on the affine hull of the carriers, if it lies inside their hull and no vertex of `simplex` improves it.
std::optional<Nearest> optimum(std::vector<ExactSupport> carriers, const std::vector<ExactSupport>& simplex) {
  Nearest nearest;
  nearest.weights = weights_of(carriers);
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    if (nearest.weights[i].sign() <= 0) return std::nullopt;
    nearest.point = nearest.point + carriers[i].w * nearest.weights[i];
    nearest.sum = nearest.sum + nearest.weights[i];
  }
  const Dyadic squared = dot(nearest.point, nearest.point);
  for (const ExactSupport& p : simplex) {
    if ((dot(nearest.point, p.w) * nearest.sum - squared).sign() < 0) return std::nullopt;
  }
  nearest.carriers = std::move(carriers);
  return nearest;
}

// The nearest point of a simplex, on a vertex, an edge or a face. Empty if the origin lies inside.
std::optional<Nearest> nearest_in(const std::vector<ExactSupport>& simplex) {
  for (int size = 1; size <= 3; ++size) {
    for (unsigned subset = 1; subset < 1u << simplex.size(); ++subset) {
      std::vector<ExactSupport> carriers;
      for (std::size_t i = 0; i < simplex.size(); ++i) {
        if (subset >> i & 1) carriers.push_back(simplex[i]);
      }
      if (static_cast<int>(carriers.size()) != size) continue;
      if (auto nearest = optimum(std::move(carriers), simplex)) return nearest;
    }
  }
  return std::nullopt;
}

// Once there is a support point that improves the nearest point. Empty if the simplex contains the origin.
std::optional<Nearest> nearer(const Nearest& nearest, const ExactSupport& w) {
  std::vector<ExactSupport> simplex = nearest.carriers;
  simplex.push_back(w);
  return nearest_in(simplex);
}

}  // namespace

Vec3 rounded_unit(const DyadicVec& v) {
  const Dyadic size = magnitude(v.x) + magnitude(v.y) + magnitude(v.z);
  const Vec3 share{rounded_ratio(v.x, size), rounded_ratio(v.y, size), rounded_ratio(v.z, size)};
  return share * (1 / norm(share));
}

ExactDifference::ExactDifference(std::vector<Vec3> a, std::vector<Vec3> b, Budget* budget)
    : a_(std::move(a)), b_(std::move(b)), budget_(budget) {
  const Aabb box_a = bounds_of(a_), box_b = bounds_of(b_);
  scale_ = std::fmax(max_abs(box_a.max - box_b.min), max_abs(box_a.min - box_b.max));
}

ExactSupport ExactDifference::at(std::uint32_t a, std::uint32_t b) const {
  return {a, b, DyadicVec(a_[a]) - DyadicVec(b_[b]), a_[a] - b_[b]};
}

ExactSupport ExactDifference::support(const DyadicVec& direction) const {
  const Vec3 unit = rounded_unit(direction);
  return at(farthest(a_, direction, unit), farthest(b_, -direction, -unit));
}

std::uint32_t ExactDifference::farthest(const std::vector<Vec3>& points, const DyadicVec& direction, Vec3 unit) const {
  spend(budget_, kVertexWork * points.size());
  const Vec3 origin = points.front();
  double highest = -INFINITY, extent = 0;
  std::vector<double> height(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i] - origin;
    height[i] = dot(unit, p);
    highest = std::fmax(highest, height[i]);
    extent = std::fmax(extent, max_abs(p));
  }
  // The error of a height: 12 roundoffs of the unit vector, 1 of the point, 3 of the dot product, times sqrt(3) for
  // three terms up to the extent: below 36. The difference of two heights has twice that error.
  const double slack = 72 * kUnitRoundoff * extent;
  std::uint32_t best = 0;
  bool has_best = false;
  Dyadic best_height;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (height[i] < highest - slack) continue;
    spend(budget_, kComparedWork);
    const Dyadic exact = dot(direction, DyadicVec(points[i]));
    if (has_best && (exact - best_height).sign() <= 0) continue;
    best = i;
    best_height = exact;
    has_best = true;
  }
  return best;
}

void place_witnesses(ExactFigure& figure, const ExactDifference& difference,
                     const std::vector<ExactSupport>& carriers, const std::vector<Dyadic>& weights) {
  DyadicVec on_a, on_b;
  Dyadic sum;
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    on_a = on_a + DyadicVec(difference.vertices_a()[carriers[i].a]) * weights[i];
    on_b = on_b + DyadicVec(difference.vertices_b()[carriers[i].b]) * weights[i];
    sum = sum + weights[i];
  }
  figure.witness_a = make_exact_point(on_a.x, on_a.y, on_a.z, sum).rounded;
  figure.witness_b = make_exact_point(on_b.x, on_b.y, on_b.z, sum).rounded;
}

ExactFigure rooted(const Dyadic& numerator, const Dyadic& denominator) {
  // The ratio has an error of 2 ulp, 4 roundoffs. The root halves it and adds one roundoff.
  constexpr double kRootError = 4 * kUnitRoundoff;
  // The square of a very short length underflows.
  const double square = rounded_ratio(numerator, denominator);
  const Dyadic longer = Dyadic(0x1p1000) * Dyadic(0x1p1000);
  ExactFigure figure;
  figure.value = square > 0x1p-900 ? std::sqrt(square) : std::sqrt(rounded_ratio(numerator * longer, denominator)) * 0x1p-1000;
  figure.lower = std::nextafter(figure.value * (1 - kRootError), 0.0);
  figure.upper = std::nextafter(figure.value * (1 + kRootError), INFINITY);
  return figure;
}

ExactFigure exact_distance(const ExactDifference& difference) {
  Nearest nearest = *nearest_in({difference.at(0, 0)});
  for (;;) {
    const ExactSupport w = difference.support(-nearest.point);
    const Dyadic squared = dot(nearest.point, nearest.point);
    if ((dot(nearest.point, w.w) * nearest.sum - squared).sign() >= 0) {
      ExactFigure figure = rooted(squared, nearest.sum * nearest.sum);
      figure.normal = rounded_unit(-nearest.point);
      place_witnesses(figure, difference, nearest.carriers, nearest.weights);
      return figure;
    }
    nearest = *nearer(nearest, w);
  }
}

int compare_distance(const ExactDifference& difference, const Dyadic& length) {
  if (length.sign() < 0) return 1;
  std::optional<Nearest> nearest = nearest_in({difference.at(0, 0)});
  for (;;) {
    const Dyadic squared = nearest ? dot(nearest->point, nearest->point) : Dyadic();
    if (squared.sign() == 0) return -length.sign();
    const Dyadic limit = length * length * nearest->sum * nearest->sum;
    const int upper = (squared - limit).sign();
    if (upper < 0) return -1;
    const ExactSupport w = difference.support(-nearest->point);
    const Dyadic along = dot(nearest->point, w.w) * nearest->sum;
    if ((along - squared).sign() >= 0) return upper;
    // All of A - B lies beyond the plane through w.
    if (along.sign() > 0 && (along * along - limit * squared).sign() > 0) return 1;
    nearest = nearer(*nearest, w);
  }
}

}  // namespace satcheck
