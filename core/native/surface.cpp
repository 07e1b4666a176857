#include "surface.hpp"

#include <stdexcept>

#include "edge_table.hpp"
#include "topology.hpp"

namespace satcheck {
namespace {

bool has_inside(const Mesh& mesh) {
  const Mesh welded = weld(mesh);
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    int balance = 0;
    for (const std::uint32_t h : edges.half_edges(e)) balance += edges.ascends(h) ? 1 : -1;
    if (balance != 0) return false;
  }
  return edges.size() > 0;
}

}  // namespace

Surface make_surface(const Mesh& mesh, bool solid) {
  if (solid && !has_inside(mesh)) {
    throw std::invalid_argument("not a solid: the surface is not closed and consistently wound");
  }
  return {mesh, build_bvh(mesh), solid};
}

}  // namespace satcheck
