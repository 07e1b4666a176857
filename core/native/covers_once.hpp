// Does a solid cover every point of its inside once?
#pragma once

#include "surface.hpp"

namespace satcheck {

// Are winding numbers with respect to the solid 0 and 1 only? True only where no two triangles cross
// and no faces lie in each other facing the same way; what then is left to tell, nested shells and
// surfaces that touch themselves, is told by samples, one a shell and one a triangle that touches.
bool covers_once(const Surface& solid);

}  // namespace satcheck
