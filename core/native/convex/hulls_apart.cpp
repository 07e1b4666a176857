// Method: start with a few points of each set. If the hulls of these points meet, the full hulls meet. If they are
// apart, find the points of each set that are farthest along the axis between them, and add these: Philip Wolfe,
// "Finding the Nearest Point in a Polytope" (1976). Where we deviate: no points are dropped, because a round visits all
// points anyway, and its cost hardly depends on the number of kept points. The depth is found alike: no point farther
// along the axis is left at its end, as in EPA.
#include "convex/hulls_apart.hpp"

#include <algorithm>

#include "base/rounding.hpp"

namespace satcheck {
namespace {

constexpr std::size_t kFirstPoints = 64;  // of each set, evenly along its order
constexpr int kRounds = 32;
constexpr int kDepthRounds = 64;
// The lower bound has to reach this share of the distance. No caller needs more.
constexpr double kGoodShare = 0.99;

std::vector<Vec3> some_of(const std::vector<Vec3>& points) {
  const std::size_t count = std::min(points.size(), kFirstPoints);
  std::vector<Vec3> some;
  const std::size_t steps = std::max<std::size_t>(count, 2) - 1;
  for (std::size_t i = 0; i < count; ++i) some.push_back(points[i * (points.size() - 1) / steps]);
  return some;
}

// A lower bound of the signed distance of two hulls with these points farthest along the normal, and against it.
double least_distance(Vec3 end_a, Vec3 end_b, Vec3 normal, double largest) {
  return dot(end_b, normal) - dot(end_a, normal) - kSupportError * largest;
}

// The point farthest along an axis; the first one in a tie.
Vec3 farthest(const std::vector<Vec3>& points, Vec3 axis) {
  std::size_t at = 0;
  double most = dot(points[0], axis);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double height = dot(points[i], axis);
    if (height > most) {
      most = height;
      at = i;
    }
  }
  return points[at];
}

}  // namespace

std::optional<PairResult> hulls_apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double largest) {
  std::vector<Vec3> some_a = some_of(a), some_b = some_of(b);
  for (int round = 0; round < kRounds; ++round) {
    const Shape hull_a = make_hull(some_a), hull_b = make_hull(some_b);
    const PairResult overlap = check_pair(hull_a, {}, hull_b, {}, Query::overlap);
    if (overlap.outcome == Outcome::undecided) return std::nullopt;
    if (overlap.outcome != Outcome::separated) return overlap;
    PairResult distance = check_pair(hull_a, {}, hull_b, {}, Query::distance);
    if (distance.outcome != Outcome::separated || !distance.has_distance) return std::nullopt;
    const Vec3 end_a = farthest(a, distance.normal), end_b = farthest(b, -distance.normal);
    const double gap = least_distance(end_a, end_b, distance.normal, largest);
    if (gap > 0 && gap >= kGoodShare * distance.upper) {
      distance.lower = std::min(distance.lower, gap);
      return distance;
    }
    some_a.push_back(end_a);
    some_b.push_back(end_b);
  }
  return std::nullopt;
}

std::optional<PairResult> depth_of_hulls(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double largest,
                                         const Budget* budget) {
  std::vector<Vec3> some_a = some_of(a), some_b = some_of(b);
  for (int round = 0; round < kDepthRounds; ++round) {
    if (budget != nullptr) budget->tell_again(0);
    PairResult depth = check_pair(make_hull(some_a), {}, make_hull(some_b), {}, Query::depth);
    if (depth.outcome == Outcome::undecided || !depth.has_distance) return std::nullopt;
    const Vec3 along = depth.normal, end_a = farthest(a, along), end_b = farthest(b, -along);
    const bool grows_a = dot(end_a, along) > dot(farthest(some_a, along), along);
    const bool grows_b = dot(end_b, along) < dot(farthest(some_b, -along), along);
    if (!grows_a && !grows_b) {
      depth.lower = std::min(depth.lower, least_distance(end_a, end_b, along, largest));
      // A point that rounding hides may be farther.
      const bool is_proven = depth.outcome == Outcome::penetrating || depth.lower > 0;
      return is_proven ? std::optional(depth) : std::nullopt;
    }
    if (grows_a) some_a.push_back(end_a);
    if (grows_b) some_b.push_back(end_b);
  }
  return std::nullopt;
}

}  // namespace satcheck
