// Contacts of a surface with itself.
#pragma once

#include <functional>
#include <vector>

#include "mesh/plane_cells.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

// Whether another triangle of the surface has more in common with t than shared corners and edges. Collinear triangles
// bound nothing and are left out.
bool has_irregular_partners(const Surface& surface, std::uint32_t t, Budget* budget = nullptr);

// Visits the triangles of a surface that wanted(t) accepts until a call returns false: plain(t) one triangle of each
// set of neighbours that have the same winding numbers everywhere, patch(cells) where the surface meets itself.
// surfaces: the surface, and perhaps another one that also cuts the patches.
void visit_uniform_parts(const std::vector<const Surface*>& surfaces, const std::function<bool(std::uint32_t)>& wanted,
                         const std::function<bool(std::uint32_t)>& plain,
                         const std::function<bool(const PlaneCells&)>& patch, Budget* budget = nullptr);

}  // namespace satcheck
