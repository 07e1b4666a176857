// What samples beside every piece of a solid tell: does it cover its inside once, and has it sheets?
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

// Are winding numbers with respect to the solid 0 and 1 only? Told by samples beside every piece of the
// surface; false also where one of them gives no answer.
bool covers_once(const Surface& solid);

// Is a piece of the surface a sheet, with no inside on either side? True also where a sample gives no answer.
bool has_sheets(const Surface& solid);

}  // namespace satcheck
