// The quick proof that the overlap of two bodies that fit is no thicker than a length, to the last digits of float64.
//
// The search for the thickness rounds distances, by up to 256 roundoffs of the largest coordinate. Here the planes of the faces
// are compared with each other (strip_cell.hpp), in differences that hardly round.
#pragma once

#include <cstdint>

#include "base/budget.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

enum class FaceFit : std::uint8_t {
  open,    // not decided
  deeper,  // a ball thicker than the length lies in both
  thin,    // none does
  fit,     // none does, and wherever the bodies meet, both are thicker than that: they may be in each other by the noise of
           // their faces, and neither is a sheet or a wire that passes through the other
};

// Of two solids and a length > 0, within the budget. All but `open` is proven. Throws std::invalid_argument unless
// both are solids. Swapping them changes nothing.
FaceFit fit_by_faces(const Surface& a, const Surface& b, double length, Budget& budget);

}  // namespace satcheck
