// Does a solid cover every point of its inside once?
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

// Are winding numbers with respect to the solid 0 and 1 only? Told by samples beside every piece of the
// surface; false also where one of them gives no answer.
bool covers_once(const Surface& solid);

}  // namespace satcheck
