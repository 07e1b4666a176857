// An affine map takes the hull to the hull, and a vertex at depth d inside to a depth of at least d times the
// map's smallest singular value. Rounding then moves it and the corners by a few units in the last place.
#include "convex/convex_hull.hpp"
#include "mesh/hull_points.hpp"

#include <algorithm>
#include <utility>

#include "base/rounding.hpp"
#include "convex/support_scan.hpp"
#include "mesh/transform.hpp"

namespace satcheck {
namespace {

// A share of the hull's largest extent: far more than rounding, far less than the details of meshes.
constexpr double kDepth = 0x1p-20;
// Limit on tests of planes against vertices: a hundredth of a second. Vertices beyond the limit are kept.
constexpr std::size_t kMostTests = 20'000'000;

// The planes of a hull's faces, four at a time; padded with the first one.
struct FacePlanes {
  explicit FacePlanes(const Polytope& hull) {
    std::vector<Vec3> on_face;
    for (std::size_t f = 0; f < hull.face_count(); ++f) on_face.push_back(hull.vertices[hull.face_vertex[hull.face_offset[f]]]);
    from = VertexLanes(on_face);
    normal = VertexLanes(hull.face_normal);
  }

  VertexLanes from, normal;
};

// Whether p lies deeper than `depth` below every face.
SATCHECK_WIDE bool is_deep(const FacePlanes& faces, Vec3 p, double depth) {
  const VertexLanes &from = faces.from, &normal = faces.normal;
  const Lanes px = all_lanes(p.x), py = all_lanes(p.y), pz = all_lanes(p.z), least = all_lanes(depth);
  for (std::size_t f = 0; f < from.padded(); f += 4) {
    const Lanes below = load_lanes(&normal.x[f]) * (load_lanes(&from.x[f]) - px) +
                        load_lanes(&normal.y[f]) * (load_lanes(&from.y[f]) - py) +
                        load_lanes(&normal.z[f]) * (load_lanes(&from.z[f]) - pz);
    if (bits_of(below > least) != 15) return false;
  }
  return true;
}

// A lower bound of the least singular value: |determinant| / (largest two), and their product is at most
// half the sum of all squares.
double least_stretch(const Vec3 (&row)[3]) {
  const double squares = norm_squared(row[0]) + norm_squared(row[1]) + norm_squared(row[2]);
  const double determinant = std::fabs(dot(row[0], cross(row[1], row[2])));
  const double rounding = 16 * kUnitRoundoff * norm(row[0]) * norm(row[1]) * norm(row[2]);
  return std::fmax(determinant - rounding, 0) / (0.5 * squares) * (1 - 16 * kUnitRoundoff);
}

}  // namespace

HullPoints find_hull_points(const Mesh& mesh, Budget* budget) {
  const Polytope hull = convex_hull(mesh.vertices, budget);
  HullPoints result;
  result.points = hull.vertices;
  if (hull.dimension < 3) return result;
  const double depth = kDepth * max_abs(bounds_of(hull.vertices).size());
  std::vector<bool> is_corner(mesh.vertices.size(), false);
  for (const std::uint32_t v : hull.source) is_corner[v] = true;
  const FacePlanes faces(hull);
  std::size_t tests = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (is_corner[v]) continue;
    tests += hull.face_count();
    if (tests > kMostTests || !is_deep(faces, mesh.vertices[v], depth)) result.points.push_back(mesh.vertices[v]);
  }
  // In an order that depends on nothing but the coordinates.
  std::sort(result.points.begin(), result.points.end(), coordinates_less);
  // Half: what the rounding of a face's normal can hide is far less.
  result.depth = 0.5 * depth;
  return result;
}

std::optional<Shape> placed_hull(const HullPoints& hull, const std::array<double, 16>& m) {
  const Vec3 row[3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
  std::vector<Vec3> placed = transform({hull.points, {}}, m).vertices;
  double largest = 0;
  for (const Vec3& p : placed) largest = std::fmax(largest, max_abs(p));
  // Each coordinate is off by at most 2 roundoffs of it, a vertex by sqrt(3) as much, and so are the corners.
  if (!(hull.depth * least_stretch(row) > 8 * kUnitRoundoff * largest)) return std::nullopt;
  return make_hull_without_faces(std::move(placed));
}

}  // namespace satcheck
