// Contacts of a surface with itself.
#pragma once

#include <functional>
#include <vector>

#include "mesh/flat_cells.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

// The other triangles of the surface that have more in common with t than shared corners and edges.
// Collinear triangles bound nothing and are left out.
std::vector<std::uint32_t> irregular_partners(const Surface& surface, std::uint32_t t, Budget* budget = nullptr);
bool has_irregular_partners(const Surface& surface, std::uint32_t t, Budget* budget = nullptr);

// Calls visit(triangle, piece, others) -> bool until it returns false, for pieces of the triangles that wanted(t)
// accepts. The winding numbers beside any point of these triangles occur beside one of the visited pieces. Pieces end
// where the surface meets itself. others: the number of irregular partners of the triangle.
void visit_uniform_pieces(const Surface& surface, const std::function<bool(std::uint32_t)>& wanted,
                          const std::function<bool(std::uint32_t, const Piece&, std::size_t)>& visit, Budget* budget = nullptr);

}  // namespace satcheck
