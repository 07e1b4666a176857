// A triangle whose corners are at most h below one plane of the hull lies in the slab of height h
// below it. So the bound is the greatest, over the triangles, of the least such h over the planes;
// only planes near the triangle are tried, which can only make the bound larger.
//
// A closed surface that lies in the boundary of a convex body wraps it a whole number of times, so
// with a positive volume and all triangles exactly in planes of the hull, the solid is the hull.
#include "convexity.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "mesh_distance.hpp"
#include "polytope.hpp"
#include "predicates.hpp"
#include "topology.hpp"
#include "triangle_pair.hpp"

namespace satcheck {
namespace {

// Depth below a plane: 1e-14 from the direction of the rounded normal, twice for its length and the
// dot product, in units of the hull's extent.
constexpr double kDepthError = 4e-14;

class Defect {
 public:
  Defect(const Mesh& mesh, const Polytope& hull)
      : mesh_(mesh),
        hull_(hull),
        boundary_(make_surface({hull.vertices, hull.triangles}, false)),
        depth_error_(kDepthError * norm(extent())) {
    // Fan triangulation: a face of n corners has n - 2 triangles, in order.
    for (std::uint32_t f = 0; f < hull.face_count(); ++f) {
      const std::uint32_t size = hull.face_offset[f + 1] - hull.face_offset[f];
      face_of_triangle_.insert(face_of_triangle_.end(), size - 2, f);
    }
    list_faces_at_vertices();
  }

  double measure(double limit) const {
    double largest = 0;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const double depth = triangle_depth(t, std::fmax(largest, 0.0));
      largest = std::fmax(largest, depth);
      if (largest > limit) return INFINITY;
    }
    return largest;
  }

 private:
  Vec3 extent() const {
    Aabb box;
    for (const Vec3& p : hull_.vertices) box.include(p);
    return box.max - box.min;
  }

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

  // Exactly 0 when the triangle lies in the plane of the face.
  double depth_below(const Corners& t, std::uint32_t face) const {
    const std::uint32_t first = hull_.face_offset[face];
    const auto at = [&](std::uint32_t i) { return hull_.vertices[hull_.face_vertex[first + i]]; };
    const bool in_plane = std::all_of(t.begin(), t.end(), [&](Vec3 p) {
      return orientation(at(0), at(1), at(2), p) == 0;
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
    return face_of_triangle_[nearest_point(boundary_, p).triangle];
  }

  const Mesh& mesh_;
  const Polytope& hull_;
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

}  // namespace

double convexity_defect(const Mesh& mesh, double limit) {
  const Mesh welded = weld(mesh);
  const Topology topology = measure_topology(welded);
  if (!topology.solid || topology.volume <= 0) return INFINITY;
  const Polytope hull = convex_hull(welded.vertices);
  const Defect defect(welded, hull);
  const double depth = defect.measure(limit);
  if (depth == 0 || std::isinf(depth)) return depth;

  // A surface close to its hull may still be a thin shell around a cavity.
  const Vec3 centre = mean(hull.vertices);
  const Surface surface = make_surface(welded, true);
  if (nearest_point(surface, centre).distance > depth && winding_number(surface, centre) == 0) {
    return INFINITY;
  }
  return depth;
}

}  // namespace satcheck
