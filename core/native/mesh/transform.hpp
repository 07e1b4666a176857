// Placements: meshes in world coordinates, and how lengths and coordinates change. Only transform() applies a placement
// to vertices.
#pragma once

#include <array>
#include <span>

#include "base/mesh.hpp"

namespace satcheck {

using Matrix = std::array<double, 16>;  // 4x4 by rows, for column vectors

// world = matrix * (x, y, z, 1), row-major; each coordinate is summed in twice the precision and
// rounded once. A reflection flips the winding. Throws std::invalid_argument when the matrix is not
// finite, not affine or singular, or a coordinate overflows.
Mesh transform(Mesh mesh, const Matrix& matrix);
// The bounds of the transformed mesh, which has vertices.
Aabb placed_bounds(const Mesh& mesh, const Matrix& matrix);
Mesh translate(const Mesh& mesh, Vec3 offset);

// The largest factor by which the matrix stretches a length: its largest singular value. The largest eigenvalue of M^T
// M in closed form: Smith, "Eigenvalues of a symmetric 3 x 3 matrix" (1961). Throws std::overflow_error if it is beyond
// float64.
double largest_stretch(const Matrix& matrix);

// An upper bound, up to rounding, of |coordinate| after the matrix, for coordinates up to `largest` before.
double largest_placed(const Matrix& matrix, double largest);

// Whether `move`, added to these points with one rounding of each coordinate, moves no point farther than `length`.
// Exact if nothing is rounded.
bool moves_within(std::span<const Vec3> points, Vec3 move, double length);

}  // namespace satcheck
