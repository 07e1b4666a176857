// The topology of what most meshes are, for less than that of any mesh.
#pragma once

#include <optional>

#include "mesh/topology.hpp"

namespace satcheck {

// measure_welded() of a mesh as weld_and_sort() leaves it, if every edge has two triangles, of different corners,
// that run it in opposite directions; else nothing.
std::optional<Topology> measure_sorted_manifold(const Mesh& sorted);

}  // namespace satcheck
