// The Minkowski difference A - B of two vertex sets without rounding: support points for exact directions. Float64
// selects the few vertices that can be farthest, and exact products decide among them.
// The distance of both sets' hulls is rounded from its exact value, or compared with a length.
#pragma once

#include <vector>

#include "base/budget.hpp"
#include "exact/dyadic.hpp"

namespace satcheck {

// The vector divided by its length; each coordinate has a relative error within 12 roundoffs. The vector must not be 0.
Vec3 rounded_unit(const DyadicVec& v);

// A vertex of A - B.
struct ExactSupport {
  std::uint32_t a = 0, b = 0;  // vertices of A and B
  DyadicVec w;                 // a - b
  Vec3 rounded;                // each coordinate with a relative error of one roundoff

  bool operator==(const ExactSupport& other) const { return a == other.a && b == other.b; }
};

class ExactDifference {
 public:
  // World vertices. budget: pays for all that is asked of the difference.
  ExactDifference(std::vector<Vec3> a, std::vector<Vec3> b, Budget* budget = nullptr);

  ExactSupport at(std::uint32_t a, std::uint32_t b) const;
  // The vertex farthest along an exact direction, which is not 0.
  ExactSupport support(const DyadicVec& direction) const;

  const std::vector<Vec3>& vertices_a() const { return a_; }
  const std::vector<Vec3>& vertices_b() const { return b_; }
  // Bounds every coordinate of A - B.
  double scale() const { return scale_; }
  Budget* budget() const { return budget_; }

 private:
  std::uint32_t farthest(const std::vector<Vec3>& points, const DyadicVec& direction, Vec3 unit) const;

  std::vector<Vec3> a_, b_;
  Budget* budget_;
  double scale_ = 0;
};

// A length of two hulls, rounded from its exact value: lower <= exact <= upper.
struct ExactFigure {
  double value = 0, lower = 0, upper = 0;
  Vec3 normal;  // unit, from A to B, world
  Vec3 witness_a, witness_b;
};

// The square root of numerator / denominator, both positive, as a figure: value and bounds.
ExactFigure rooted(const Dyadic& numerator, const Dyadic& denominator);

// Sets the witness points from a point of A - B. The point is a weighted mean of difference vertices, with weights >= 0
// that are not all 0. The same weights on the vertices of A and of B give the witness points, each rounded once.
void place_witnesses(ExactFigure& figure, const ExactDifference& difference,
                     const std::vector<ExactSupport>& carriers, const std::vector<Dyadic>& weights);

// A and B must have no common point.
ExactFigure exact_distance(const ExactDifference& difference);

// Sign of distance - length, for hulls of any dimension; the distance of hulls that meet is 0.
int compare_distance(const ExactDifference& difference, const Dyadic& length);

}  // namespace satcheck
