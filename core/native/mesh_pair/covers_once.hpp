// Decides by samples beside every piece of a solid whether it covers its inside once, and whether it has sheets.
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

// Whether winding numbers with respect to the solid are 0 and 1 only, by samples beside every piece of the surface.
// Also false if a sample gives no answer.
bool covers_once(const Surface& solid);

// Whether a piece of the surface is a sheet, without an inside on either side. Also true if a sample gives no answer.
// Triangles no wider than `crack` make no sheet: those that close a crack may lie on each other.
bool has_sheets(const Surface& solid, double crack);

}  // namespace satcheck
