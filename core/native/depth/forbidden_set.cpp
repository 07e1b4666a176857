#include "depth/forbidden_set.hpp"

#include "base/numeric_range.hpp"
#include "base/rounding.hpp"
#include "convex/convex_hull.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// A rounded facet normal is off by at most 1e-14 radians (rounded_normal), plus the roundings of its length: 1.1e-14 in
// all. The error of a height is this angle times the distance of the point from the facet's corner. Within the set this
// distance is at most 7 times the largest coordinate of the bodies (sqrt(3) * 4, rounded up).
constexpr double kFacetError = 7 * 1.1e-14;
// Differences of vertices, dot products and sums over a box that the set holds.
constexpr double kSetError = 128 * kUnitRoundoff;

// Measured steps of testing a part of a box against a facet.
constexpr std::uint64_t kHeightWork = 6;
// Limit of the factor. For a facet nearly parallel to an axis, the best factor would be so large that rounding matters.
constexpr double kMostFactor = 64;
// Roundings of the height of a part of a box, as a share of 1 + factor times the largest coordinate and offset: a sum of
// normals 2 a coordinate, products, their sum and the difference 8, over three coordinates.
constexpr double kPartError = 32 * kUnitRoundoff;

// The length of a small normal may be out of range; that of its multiple is not.
Vec3 unit(Vec3 normal) {
  const Vec3 scaled = normal * (1 / max_abs(normal));
  return scaled * (1 / norm(scaled));
}

}  // namespace

ForbiddenSet::Exit ForbiddenSet::exit(Vec3 t) const {
  Exit least{empty() ? -INFINITY : INFINITY, {}};
  for (std::size_t k = 0; k < normal.size(); ++k) {
    const double height = offset[k] - dot(normal[k], t);
    if (height < least.depth) least = {height, normal[k]};
  }
  return least;
}

bool ForbiddenSet::holds(Vec3 t) const {
  for (std::size_t k = 0; k < normal.size(); ++k) {
    if (!(offset[k] - dot(normal[k], t) > 0)) return false;
  }
  return !empty();
}

ForbiddenSet::Reach ForbiddenSet::reach(Vec3 c, Vec3 h) const {
  if (empty()) return {-INFINITY, false};
  Reach result{INFINITY, true};
  for (std::size_t k = 0; k < normal.size(); ++k) {
    const double middle = dot(normal[k], c), spread = reach_along(normal[k], h);
    if (middle + spread < offset[k]) continue;
    if (middle - spread >= offset[k]) return {-INFINITY, false};
    result.length = std::fmin(result.length, offset[k]);
    ++result.facets;
  }
  return result;
}

ForbiddenSet ForbiddenSet::within(Vec3 c, Vec3 h) const {
  ForbiddenSet part;
  part.box = box;
  part.number = number;
  for (std::size_t k = 0; k < normal.size(); ++k) {
    if (dot(normal[k], c) + reach_along(normal[k], h) < offset[k]) continue;
    part.normal.push_back(normal[k]);
    part.offset.push_back(offset[k]);
    part.facet.push_back(facet[k]);
  }
  return part;
}

double ForbiddenSet::reach_beyond(Vec3 c, Vec3 h, Vec3 cut, double at, double least,
                                  Budget& budget) const {
  if (empty()) return -INFINITY;
  const double size = max_abs(c) + max_abs(h);
  const auto height = [&](Vec3 m) {
    return dot(m, c) + std::fabs(m.x) * h.x + std::fabs(m.y) * h.y + std::fabs(m.z) * h.z;
  };
  double length = INFINITY;
  for (std::size_t k = 0; k < normal.size(); ++k) {
    // An upper bound of the greatest height of that part over this facet: the height of the box over the sum of the
    // facet's normal and any positive multiple of the plane's normal, minus the same multiple of the offset. As a
    // function of the factor, the bound is convex, with bends where a coordinate of the sum vanishes.
    const Vec3 n = normal[k];
    bool holds = height(n) < offset[k];
    for (int axis = 0; axis < 3 && !holds; ++axis) {
      const double factor = -n[axis] / cut[axis];
      if (!(factor > 0 && factor <= kMostFactor)) continue;
      const double error = kPartError * (1 + factor) * (size + std::fabs(at));
      holds = height(n + cut * factor) - factor * at + error < offset[k];
    }
    if (!holds) length = std::fmin(length, offset[k]);
    if (length < least) {
      budget.spend(kHeightWork * (k + 1));
      return length;
    }
  }
  budget.spend(kHeightWork * normal.size());
  return length;
}

ForbiddenSet forbidden_set(const std::vector<Vec3>& part_of_a, const std::vector<Vec3>& part_of_b,
                           Budget* budget) {
  std::vector<Vec3> differences;
  double scale = 0;
  differences.reserve(part_of_a.size() * part_of_b.size());
  for (const Vec3& q : part_of_b) {
    for (const Vec3& p : part_of_a) {
      differences.push_back(q - p);
      scale = std::fmax(scale, std::fmax(max_abs(p), max_abs(q)));
    }
  }
  ForbiddenSet result;
  if (!are_in_range(differences)) return result;
  const HullTriangles hull = hull_triangles(differences, budget);
  if (hull.triangles.empty()) return result;
  const double pad = (kFacetError + kSetError) * scale;
  Vec3 sum;
  for (const Triangle& t : hull.triangles) {
    const Vec3 a = hull.points[t[0]], b = hull.points[t[1]], c = hull.points[t[2]];
    result.normal.push_back(unit(rounded_normal(a, b, c)));
    result.facet.push_back(dot(result.normal.back(), a));
    result.offset.push_back(result.facet.back() - pad);
    for (const Vec3& v : {a, b, c}) {
      result.box.include(v);
      sum = sum + v;
    }
  }
  // The region within the planes is then connected with the inside of the hull, and therefore inside it.
  const Vec3 middle = sum * (1.0 / static_cast<double>(3 * hull.triangles.size()));
  return result.exit(middle).depth > 0 ? result : ForbiddenSet{};
}

}  // namespace satcheck
