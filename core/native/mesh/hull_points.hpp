// The vertices of a mesh that can be corners of its convex hull after any affine map. They are computed once for a
// mesh, so that a placed mesh needs no new hull for support points.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/mesh.hpp"
#include "convex/shape.hpp"

namespace satcheck {

struct HullPoints {
  std::vector<Vec3> points;  // in the mesh's frame
  // Every other vertex lies deeper than this inside the hull. 0: unknown.
  double depth = 0;
};

HullPoints find_hull_points(const Mesh& mesh, Budget* budget = nullptr);

// The hull, without faces, of the mesh's vertices placed by a 4x4 matrix as in transform(). Empty if the rounding of
// the placement may bring another vertex to the surface. Throws what transform() throws.
std::optional<Shape> placed_hull(const HullPoints& hull, const std::array<double, 16>& matrix);

}  // namespace satcheck
