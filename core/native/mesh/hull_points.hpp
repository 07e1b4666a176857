// Which vertices of a mesh can be corners of its convex hull, wherever an affine map puts it: found once a
// mesh, so that a placed one needs no hull of its own for support points.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/mesh.hpp"
#include "convex/shape.hpp"

namespace satcheck {

struct HullPoints {
  std::vector<Vec3> points;  // in the mesh's frame
  // Every other vertex lies deeper than this inside the hull. 0: nothing is known of the others.
  double depth = 0;
};

HullPoints find_hull_points(const Mesh& mesh);

// The hull of the mesh's vertices placed by a 4x4 matrix, as transform() does, without its faces. Nothing
// where the rounding of the placement may bring another vertex to the surface. Throws what transform() does.
std::optional<Shape> placed_hull(const HullPoints& hull, const std::array<double, 16>& matrix);

}  // namespace satcheck
