// P. Wolfe, "Finding the Nearest Point in a Polytope" (1976), in exact arithmetic. Like GJK it comes nearer with every
// support point. It ends without a tolerance, when a support point is no farther along the direction. The nearest point
// of a simplex is found by its optimality: it is a point of an affine hull with positive weights, and no other vertex
// improves it.

#include "convex/exact_distance.hpp"

#include <optional>

namespace satcheck {
namespace {

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
