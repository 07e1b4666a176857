// How a placement changes lengths and coordinates.
#pragma once

#include <array>

namespace satcheck {

// How much longer the matrix can make a length: its largest singular value. The largest eigenvalue of M^T M in
// closed form: Smith, "Eigenvalues of a symmetric 3 x 3 matrix" (1961). std::overflow_error where it leaves the
// range of numbers.
double largest_stretch(const std::array<double, 16>& matrix);

// An upper bound, but for rounding, of |coordinate| after the matrix, for coordinates up to `largest` before.
double largest_placed(const std::array<double, 16>& matrix, double largest);

}  // namespace satcheck
