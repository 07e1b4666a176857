// A triangle whose corners are at most h below one plane of the hull lies in the slab of height h
// below it. Let the depth d be the greatest, over the triangles, of the least such h over the planes;
// only planes near the triangle are tried, which can only make d larger.
//
// d = 0: a closed surface that lies in the boundary of a convex body wraps it a whole number of
// times, so with a positive volume the solid is the hull.
//
// d > 0: no triangle reaches the core, the points deeper than d below all planes. The core is convex,
// so it is material as a whole if one of its points is. For a point c of depth D > d, the depth along
// the way from a corner v to c grows at least linearly, so the core begins within |c - v| d / D of v.
// By convexity, the greatest of these distances over the corners bounds the distance from the hull to the core. d alone
// is not enough: every triangle of a thin plate is near the plane of its top.
//
// Most convex meshes need no hull: Kurt Mehlhorn et al., "Checking Geometric Programs or Verification of Geometric
// Structures" (1999). A point is below the planes of all triangles, and a ray from it crosses one triangle. Seen from the
// point, the surface then covers each direction once. If no edge bends inward either, the solid is convex.
#include "convex/convex_hull.hpp"
#include "mesh/convexity.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "base/edge_table.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/topology.hpp"
#include "mesh/surface.hpp"

namespace satcheck {
namespace {

// Depth below a plane: 1e-14 from the direction of the rounded normal, twice for its length and the
// dot product, in units of the hull's extent.
constexpr double kDepthError = 4e-14;

// Measured steps of a triangle and a plane.
constexpr std::uint64_t kPlaneWork = 15;

// The number of points tried on the way inward from a corner, each at half the distance of the last one, and the ratio
// of distance to depth that is good enough. A corner of a cube has 1.7.
constexpr int kInwardSteps = 24;
constexpr double kGoodRatio = 4;

class Defect {
 public:
  Defect(const Mesh& mesh, const Polytope& hull, Budget* budget)
      : mesh_(mesh),
        hull_(hull),
        budget_(budget),
        boundary_(make_surface({hull.vertices, hull.triangles}, false)),
        depth_error_(kDepthError * norm(bounds_of(hull_.vertices).size())) {
    // Fan triangulation: a face of n corners has n - 2 triangles, in order.
    for (std::uint32_t f = 0; f < hull.face_count(); ++f) {
      const std::uint32_t size = hull.face_offset[f + 1] - hull.face_offset[f];
      face_of_triangle_.insert(face_of_triangle_.end(), size - 2, f);
    }
    list_faces_at_vertices();
  }

  // The depth d, infinite beyond the limit.
  double depth(double limit) const {
    double largest = 0;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      largest = std::fmax(largest, triangle_depth(t, largest));
      if (largest > limit) return INFINITY;
    }
    return largest;
  }

  // Depth of a point below the hull's planes, rounded down; 0 or less when it is not inside.
  double point_depth(Vec3 p) const {
    const NearestPoint nearest = nearest_point(boundary_, p, budget_);
    const std::uint32_t face = face_of_triangle_[nearest.triangle];
    const bool below = dot(hull_.face_normal[face], nearest.point - p) > depth_error_;
    return below ? nearest.distance - depth_error_ : 0;
  }

  // A bound of the distance from any point of the hull to the core of the given depth; infinite beyond the limit.
  // `centre`: a point of the core.
  double reach(double depth, Vec3 centre, double limit) const {
    const double centre_depth = point_depth(centre);
    double farthest = 0;
    for (std::uint32_t v = 0; v < hull_.vertices.size(); ++v) {
      const Vec3 corner = hull_.vertices[v];
      double ratio = norm(centre - corner) / centre_depth;
      // In slender bodies, a point near the corner may be nearly as deep and much nearer.
      const Vec3 inward = inward_direction(v);
      double step = norm(centre - corner) / 2;
      for (int k = 0; k < kInwardSteps && ratio > kGoodRatio && step > depth; ++k, step /= 2) {
        const double there = point_depth(corner + inward * step);
        if (there > depth) ratio = std::fmin(ratio, step / there);
      }
      farthest = std::fmax(farthest, ratio * depth);
      if (farthest > limit) return INFINITY;
    }
    return farthest;
  }

 private:
  void list_faces_at_vertices() {
    faces_at_.resize(hull_.vertices.size());
    for (std::uint32_t f = 0; f < hull_.face_count(); ++f) {
      for (std::uint32_t i = hull_.face_offset[f]; i < hull_.face_offset[f + 1]; ++i) {
        faces_at_[hull_.face_vertex[i]].push_back(f);
      }
    }
    hull_vertex_.assign(mesh_.vertices.size(), std::nullopt);
    for (std::uint32_t v = 0; v < hull_.source.size(); ++v) hull_vertex_[hull_.source[v]] = v;
  }

  // Opposite to the mean of the normals at a corner of the hull.
  Vec3 inward_direction(std::uint32_t vertex) const {
    Vec3 sum;
    for (const std::uint32_t f : faces_at_[vertex]) sum = sum - hull_.face_normal[f];
    const double length = norm(sum);
    return length > 0 ? sum * (1 / length) : sum;
  }

  // Exactly 0 when the triangle lies in the plane of the face.
  double depth_below(const Corners& t, std::uint32_t face) const {
    spend(budget_, kPlaneWork);
    const std::uint32_t first = hull_.face_offset[face];
    const auto at = [&](std::uint32_t i) { return hull_.vertices[hull_.face_vertex[first + i]]; };
    const bool in_plane = std::all_of(t.begin(), t.end(), [&](Vec3 p) {
      return orientation(at(0), at(1), at(2), p, budget_) == 0;
    });
    if (in_plane) return 0;
    double depth = 0;
    for (const Vec3& p : t) depth = std::fmax(depth, dot(hull_.face_normal[face], at(0) - p));
    return depth + depth_error_;
  }

  // The least depth over the planes tried; stops at one that is no worse than `good_enough`.
  double triangle_depth(std::uint32_t triangle, double good_enough) const {
    const Corners t = corners(mesh_, triangle);
    const Vec3 centre = (t[0] + t[1] + t[2]) * (1.0 / 3);
    double depth = depth_below(t, nearest_face(centre));
    for (int i = 0; i < 3 && depth > good_enough; ++i) {
      const std::optional<std::uint32_t> v = hull_vertex_[mesh_.triangles[triangle][i]];
      if (!v) {
        depth = std::fmin(depth, depth_below(t, nearest_face(t[i])));
        continue;
      }
      for (const std::uint32_t f : faces_at_[*v]) depth = std::fmin(depth, depth_below(t, f));
    }
    return depth;
  }

  std::uint32_t nearest_face(Vec3 p) const {
    return face_of_triangle_[nearest_point(boundary_, p, budget_).triangle];
  }

  const Mesh& mesh_;
  const Polytope& hull_;
  Budget* budget_;
  Surface boundary_;
  double depth_error_;
  std::vector<std::uint32_t> face_of_triangle_;
  std::vector<std::vector<std::uint32_t>> faces_at_;
  std::vector<std::optional<std::uint32_t>> hull_vertex_;
};

Vec3 mean(const std::vector<Vec3>& points) {
  Vec3 sum;
  for (const Vec3& p : points) sum = sum + p * (1.0 / static_cast<double>(points.size()));
  return sum;
}

// Whether corners lie on both sides of the plane of a triangle, so that the triangle is not in the boundary of the
// hull. Only a few planes are tried: if the mesh is dented, a few triangles usually show it.
bool is_dented(const Mesh& mesh) {
  constexpr std::size_t kPlanes = 8;
  const std::size_t step = std::max<std::size_t>(1, mesh.triangles.size() / kPlanes);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
    const Corners t = corners(mesh, static_cast<std::uint32_t>(i));
    const TrianglePlane plane(t[0], t[1], t[2]);
    bool above = false, below = false;
    for (std::size_t j = 0; j < mesh.triangles.size(); j += 2) {  // a vertex has about two triangles of its own
      const int side = plane.side(mesh.vertices[mesh.triangles[j][0]]);
      above = above || side > 0;
      below = below || side < 0;
      if (above && below) return true;
    }
  }
  return false;
}

// inward: some edge of two triangles does, so that the surface is not its hull. outward: every edge has two triangles
// that run it in opposite directions, and none bends inward.
enum class Bends : std::uint8_t { inward, outward, unknown };

Bends bends_of(const Mesh& welded) {
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  Bends bends = Bends::outward;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    if (h.size() != 2 || edges.ascends(h[0]) == edges.ascends(h[1])) bends = Bends::unknown;
    if (h.size() != 2) continue;
    const Corners t = corners(welded, h[0] / 3);
    const std::uint32_t apex = welded.triangles[h[1] / 3][(h[1] + 2) % 3];
    if (TrianglePlane(t[0], t[1], t[2]).side(welded.vertices[apex]) > 0) return Bends::inward;
  }
  return bends;
}

// Along no edge of common meshes, so that the ray meets none.
constexpr Vec3 kAskew{0.71, 0.43, 0.57};

// Whether a triangle may have a point with no smaller coordinates than this one, as all points of a ray along kAskew have.
bool reaches_octant(const Corners& c, Vec3 point) {
  for (int axis = 0; axis < 3; ++axis) {
    if (c[0][axis] < point[axis] && c[1][axis] < point[axis] && c[2][axis] < point[axis]) return false;
  }
  return true;
}

// Whether the point is below the planes of all triangles, and a ray from it crosses one of them.
bool is_seen_once_from(const Mesh& mesh, Vec3 point) {
  const Vec3 ahead = point + kAskew * norm(bounds_of(mesh.vertices).size());
  std::size_t crossed = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners c = corners(mesh, t);
    if (TrianglePlane(c[0], c[1], c[2]).side(point) >= 0) return false;
    if (!reaches_octant(c, point)) continue;
    int sides = 1;
    for (std::size_t i = 0; i < 3 && sides > 0; ++i) sides = orientation(point, ahead, c[i], c[(i + 1) % 3]);
    if (sides == 0) return false;
    if (sides > 0) ++crossed;
  }
  return crossed == 1;
}

}  // namespace

double convexity_defect(const Mesh& mesh, double limit, Budget* budget) {
  if (limit == 0 && is_dented(mesh)) return INFINITY;
  const Mesh welded = weld(mesh);
  if (limit == 0) {
    const Bends bends = bends_of(welded);
    if (bends == Bends::inward) return INFINITY;
    if (bends == Bends::outward && is_seen_once_from(welded, mean(welded.vertices))) return 0;
  }
  const Topology topology = measure_topology(welded);
  if (!topology.solid || topology.volume <= 0) return INFINITY;
  const Polytope hull = convex_hull(welded.vertices, budget);
  const Defect defect(welded, hull, budget);
  const double depth = defect.depth(limit);
  if (depth == 0 || std::isinf(depth)) return depth;

  const Vec3 centre = mean(hull.vertices);
  const bool in_core = defect.point_depth(centre) > depth;
  const Surface surface = make_surface(welded, true);
  if (!in_core || winding_number(surface, centre, budget).value_or(0) == 0) return INFINITY;
  return defect.reach(depth, centre, limit);
}

}  // namespace satcheck
