#include "depth/forbidden_set.hpp"

#include "base/numeric_range.hpp"
#include "base/tolerances.hpp"
#include "convex/polytope.hpp"

namespace satcheck {
namespace {

// A rounded facet normal is off by at most 1e-14 radians (rounded_normal) and the roundings of its
// length, 1.1e-14 in all: a point is misjudged by that angle times its distance from the facet's corner. Within
// the set that is at most 7 times the largest coordinate of the bodies, sqrt(3) * 4 rounded up.
constexpr double kFacetError = 7 * 1.1e-14;
// Differences of vertices, dot products and sums over a box that the set holds.
constexpr double kSetError = 128 * kUnitRoundoff;

}  // namespace

ForbiddenSet::Exit ForbiddenSet::exit(Vec3 t) const {
  Exit least{empty() ? -INFINITY : INFINITY, {}};
  for (std::size_t k = 0; k < normal.size(); ++k) {
    const double height = offset[k] - dot(normal[k], t);
    if (height < least.depth) least = {height, normal[k]};
  }
  return least;
}

ForbiddenSet::Reach ForbiddenSet::reach(Vec3 c, Vec3 h) const {
  if (empty()) return {-INFINITY, false};
  Reach result{INFINITY, true};
  for (std::size_t k = 0; k < normal.size(); ++k) {
    const Vec3& n = normal[k];
    const double middle = n.x * c.x + n.y * c.y + n.z * c.z;
    const double spread = std::fabs(n.x) * h.x + std::fabs(n.y) * h.y + std::fabs(n.z) * h.z;
    if (middle + spread < offset[k]) continue;
    if (middle - spread >= offset[k]) return {-INFINITY, false};
    result.length = std::fmin(result.length, offset[k]);
  }
  return result;
}

ForbiddenSet forbidden_set(const std::vector<Vec3>& part_of_a, const std::vector<Vec3>& part_of_b) {
  std::vector<Vec3> differences;
  double scale = 0;
  differences.reserve(part_of_a.size() * part_of_b.size());
  const auto in_reach = [](double x) { return std::fabs(x) < kSmallestCoordinate ? 0.0 : x; };
  for (const Vec3& q : part_of_b) {
    for (const Vec3& p : part_of_a) {
      const Vec3 d = q - p;
      differences.push_back({in_reach(d.x), in_reach(d.y), in_reach(d.z)});
      scale = std::fmax(scale, std::fmax(max_abs(p), max_abs(q)));
    }
  }
  ForbiddenSet result;
  if (!are_in_range(differences)) return result;
  const Polytope hull = convex_hull(differences);
  if (hull.dimension != 3) return result;
  for (const Vec3& v : hull.vertices) result.box.include(v);
  const double pad = (kFacetError + kSetError) * scale;
  Vec3 sum;
  for (const Vec3& v : hull.vertices) sum = sum + v;
  for (std::size_t f = 0; f < hull.face_count(); ++f) {
    const Vec3 v = hull.vertices[hull.face_vertex[hull.face_offset[f]]];
    result.normal.push_back(hull.face_normal[f]);
    result.facet.push_back(dot(hull.face_normal[f], v));
    result.offset.push_back(result.facet.back() - pad);
  }
  // What the planes bound is then connected with the inside of the hull, and therefore inside it.
  const Vec3 middle = sum * (1 / static_cast<double>(hull.vertices.size()));
  return result.exit(middle).depth > 0 ? result : ForbiddenSet{};
}

}  // namespace satcheck
