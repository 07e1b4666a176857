// How a placement changes lengths and coordinates.
#pragma once

#include <array>

namespace satcheck {

// The largest factor by which the matrix stretches a length: its largest singular value. The largest eigenvalue of M^T
// M in closed form: Smith, "Eigenvalues of a symmetric 3 x 3 matrix" (1961). Throws std::overflow_error if it is beyond
// float64.
double largest_stretch(const std::array<double, 16>& matrix);

// An upper bound, up to rounding, of |coordinate| after the matrix, for coordinates up to `largest` before.
double largest_placed(const std::array<double, 16>& matrix, double largest);

}  // namespace satcheck
