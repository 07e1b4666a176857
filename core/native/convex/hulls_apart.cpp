// Method: start with a few points of each set, whose hulls overlap no deeper than the full hulls. Find the points of each
// set that are farthest along the normal of the few, and add these: Philip Wolfe, "Finding the Nearest Point in a
// Polytope" (1976). Where we deviate: no points are dropped, because a round visits all points anyway, and its cost hardly
// depends on the number of kept points. A depth is found alike: no point farther along the normal is left at its end, as
// in EPA.
#include "convex/hulls_apart.hpp"

#include <algorithm>

#include "base/rounding.hpp"

namespace satcheck {
namespace {

constexpr std::size_t kFirstPoints = 64;  // of each set, evenly along its order
constexpr int kMostRounds = 64;
// For a distance, the lower bound has to reach this share of it. No caller needs more.
constexpr double kGoodShare = 0.99;

// A set of points, and the few of them that stand for it.
class PointSet {
 public:
  explicit PointSet(const std::vector<Vec3>& points) : points_(points) {
    const std::size_t count = std::min(points.size(), kFirstPoints), steps = std::max<std::size_t>(count, 2) - 1;
    for (std::size_t i = 0; i < count; ++i) few_.push_back(points[i * (points.size() - 1) / steps]);
  }

  Shape hull_of_few() const { return make_hull(few_); }

  // The point of the set farthest along an axis; the first one in a tie.
  Vec3 farthest(Vec3 axis) const {
    std::size_t at = 0;
    double most = dot(points_[0], axis);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const double height = dot(points_[i], axis);
      if (height > most) at = i, most = height;
    }
    return points_[at];
  }

  // False if one of the few is as far along the axis.
  bool add(Vec3 point, Vec3 axis) {
    const double height = dot(point, axis);
    if (std::any_of(few_.begin(), few_.end(), [&](Vec3 p) { return dot(p, axis) >= height; })) return false;
    few_.push_back(point);
    return true;
  }

 private:
  const std::vector<Vec3>& points_;
  std::vector<Vec3> few_;
};

// A lower bound of the signed distance of two hulls with these points farthest along the normal, and against it.
double least_distance(Vec3 end_a, Vec3 end_b, Vec3 normal, double largest) {
  return dot(end_b, normal) - dot(end_a, normal) - kSupportError * largest;
}

}  // namespace

std::optional<PairResult> check_hulls_of(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double largest, Query query,
                                         const Budget* budget) {
  const bool wants_depth = query == Query::depth;
  PointSet set_a(a), set_b(b);
  for (int round = 0; round < kMostRounds; ++round) {
    if (budget != nullptr) budget->tell_again(0);
    PairResult few = check_pair(set_a.hull_of_few(), {}, set_b.hull_of_few(), {}, Query::depth, MethodChoice::automatic,
                                wants_depth ? INFINITY : 0.0);
    if (few.outcome == Outcome::undecided) return std::nullopt;
    if (!wants_depth && few.outcome != Outcome::separated) return few;
    if (!few.has_distance) return std::nullopt;
    const Vec3 along = few.normal, end_a = set_a.farthest(along), end_b = set_b.farthest(-along);
    const double least = least_distance(end_a, end_b, along, largest);
    const bool is_good = !wants_depth && least > 0 && least >= kGoodShare * few.upper;
    const bool grows_a = !is_good && set_a.add(end_a, along), grows_b = !is_good && set_b.add(end_b, -along);
    if (grows_a || grows_b) continue;
    few.lower = std::min(few.lower, least);
    // A point that rounding hides may be farther.
    const bool is_proven = few.outcome == Outcome::penetrating || few.lower > 0;
    return is_proven ? std::optional(few) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace satcheck
