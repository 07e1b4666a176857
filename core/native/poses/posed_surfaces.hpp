// Two surfaces in one pose, compared in the file frame of A. No vertex is placed in the world.
#pragma once

#include "mesh/surface.hpp"
#include "poses/posed_body.hpp"

namespace satcheck {

enum class Meeting : std::uint8_t { unclear, apart, crossing };

// apart: the surfaces are closed and farther apart than `gap`, and neither reaches into the material of the other.
// crossing: two triangles cross, and no translation up to `depth` ends that. Each triangle bounds material, is within
// it or is a sheet, so the bodies overlap, with any fill of their holes. gap, depth: world units.
Meeting meeting_of(const Surface& a, const PosedPlace& at_a, const Surface& b, const PosedPlace& at_b, double gap,
                   double depth);

}  // namespace satcheck
