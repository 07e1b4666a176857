// The quick proof that surfaces which may be off explain an overlap: both bodies, made a little smaller, are free of each
// other.
//
// Each vertex moves into its body, and each point of a surface no farther than the farthest vertex. The winding number of a
// point changes only where the surface passes over it: a point that lies deeper than that is still inside. So no point
// is deeper than that in both bodies, and no point of one surface is deeper in the other body than the sum of both.
#pragma once

#include "mesh/surface.hpp"

namespace satcheck {

// Whether two solids are free of each other when no vertex of a moves farther than most_a, and none of b than most_b.
// False: not found. Throws std::invalid_argument unless both are solids. Swapping them with their lengths changes nothing.
// poll: called now and then.
bool free_when_shrunk(const Surface& a, const Surface& b, double most_a, double most_b, const Poll& poll = {});

}  // namespace satcheck
