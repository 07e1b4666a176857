#include "convex/exact_difference.hpp"

#include <algorithm>

#include "base/rounding.hpp"
#include "exact/exact_point.hpp"

namespace satcheck {

namespace {

Dyadic magnitude(const Dyadic& value) { return value.sign() < 0 ? -value : value; }

}  // namespace

Vec3 rounded_unit(const DyadicVec& v) {
  const Dyadic size = magnitude(v.x) + magnitude(v.y) + magnitude(v.z);
  const Vec3 share{rounded_ratio(v.x, size), rounded_ratio(v.y, size), rounded_ratio(v.z, size)};
  return share * (1 / norm(share));
}

ExactDifference::ExactDifference(std::vector<Vec3> a, std::vector<Vec3> b) : a_(std::move(a)), b_(std::move(b)) {
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

std::uint32_t ExactDifference::farthest(const std::vector<Vec3>& points, const DyadicVec& direction, Vec3 unit) {
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

}  // namespace satcheck
