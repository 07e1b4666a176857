// The hull of any point set: distinct points, dimension by exact signs, then quickhull or, in a
// plane, A. M. Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions" (1979).
// Points are sorted by their coordinates first, so the result does not depend on their order.
#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "base/key_sort.hpp"
#include "base/numeric_range.hpp"
#include "convex/convex_hull.hpp"
#include "convex/quickhull.hpp"
#include "exact/predicates.hpp"
#include "convex/polytope_faces.hpp"

namespace satcheck {
namespace {

struct DistinctPoints {
  std::vector<Vec3> point;            // by x, then y, then z
  std::vector<std::uint32_t> source;  // the first input index of each
};

DistinctPoints distinct(const std::vector<Vec3>& points) {
  if (points.empty()) throw std::invalid_argument("the convex hull needs at least one point");
  require_in_range(points, "point");
  DistinctPoints result;
  for (const std::uint32_t i : order_by_coordinates(points)) {
    if (!result.point.empty() && points[i] == result.point.back()) continue;
    result.point.push_back(points[i]);
    result.source.push_back(i);
  }
  return result;
}

// The index with the largest `score` among those that `accept` allows; the size of the set if there is none. `accept`
// is exact. The score is rounded and only prefers well-shaped choices.
template <class Score, class Accept>
std::uint32_t best(const std::vector<Vec3>& points, Score score, Accept accept) {
  const auto count = static_cast<std::uint32_t>(points.size());
  std::uint32_t winner = 0;
  double highest = -1;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double s = score(points[i]);
    if (s > highest) {
      highest = s;
      winner = i;
    }
  }
  if (accept(points[winner])) return winner;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (accept(points[i])) return i;
  }
  return count;
}

// The corners of the hull of coplanar points, counter-clockwise along `drop_axis`.
std::vector<std::uint32_t> planar_hull(const std::vector<Vec3>& points, int drop_axis) {
  const int i = drop_axis == 2 ? 0 : drop_axis + 1;
  const int j = drop_axis == 0 ? 2 : drop_axis - 1;
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (points[a][i] != points[b][i]) return points[a][i] < points[b][i];
    return points[a][j] < points[b][j];
  });
  std::vector<std::uint32_t> chain;
  const auto extend = [&](std::uint32_t p, std::size_t base) {
    while (chain.size() >= base + 2 &&
           orientation_2d(points[chain[chain.size() - 2]], points[chain.back()], points[p],
                          drop_axis) <= 0) {
      chain.pop_back();
    }
    chain.push_back(p);
  };
  for (const std::uint32_t p : order) extend(p, 0);
  chain.pop_back();
  const std::size_t upper = chain.size();
  for (auto p = order.rbegin(); p != order.rend(); ++p) extend(*p, upper);
  chain.pop_back();
  return chain;
}

int widest_projection(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = rounded_normal(a, b, c);
  const Vec3 size{std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)};
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

Polytope lower_dimensional(const DistinctPoints& set, const std::vector<std::uint32_t>& corners,
                           int dimension) {
  Polytope result;
  result.dimension = dimension;
  for (const std::uint32_t i : corners) {
    result.vertices.push_back(set.point[i]);
    result.source.push_back(set.source[i]);
  }
  return result;
}

// The largest dimension of a simplex of these points, and `dimension` + 1 of them that span it.
struct Simplex {
  int dimension;
  std::array<std::uint32_t, 4> corner;
};

Simplex first_simplex(const std::vector<Vec3>& points) {
  const auto count = static_cast<std::uint32_t>(points.size());
  const std::uint32_t last = count - 1;
  if (count == 1) return {0, {0}};

  const Vec3 a = points.front(), b = points.back();  // both extreme
  const std::uint32_t third = best(
      points, [&](Vec3 p) { return norm_squared(cross(b - a, p - a)); },
      [&](Vec3 p) { return !collinear(a, b, p); });
  if (third == count) return {1, {0, last}};

  const Vec3 c = points[third];
  const Vec3 normal = rounded_normal(a, b, c);
  const std::uint32_t fourth = best(
      points, [&](Vec3 p) { return std::fabs(dot(normal, p - a)); },
      [&](Vec3 p) { return orientation(a, b, c, p) != 0; });
  if (fourth == count) return {2, {0, last, third}};
  return {3, {0, last, third, fourth}};
}

}  // namespace

Polytope convex_hull(const std::vector<Vec3>& points, Budget* budget) {
  const DistinctPoints set = distinct(points);
  const auto [dimension, corner] = first_simplex(set.point);
  if (dimension == 0) return lower_dimensional(set, {corner[0]}, 0);
  if (dimension == 1) return lower_dimensional(set, {corner[0], corner[1]}, 1);
  if (dimension == 2) {
    const int drop_axis = widest_projection(set.point[corner[0]], set.point[corner[1]], set.point[corner[2]]);
    Polytope flat = lower_dimensional(set, planar_hull(set.point, drop_axis), 2);
    add_flat_faces(flat);
    return flat;
  }
  Polytope solid;
  solid.dimension = 3;
  add_solid_faces(solid, set.point, quickhull(set.point, corner, budget), set.source);
  return solid;
}

HullTriangles hull_triangles(const std::vector<Vec3>& points, Budget* budget) {
  HullTriangles result{distinct(points).point, {}};
  const auto [dimension, corner] = first_simplex(result.points);
  if (dimension == 3) result.triangles = quickhull(result.points, corner, budget);
  return result;
}

}  // namespace satcheck
