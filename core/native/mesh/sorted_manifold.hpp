// A fast path for the topology of closed manifold meshes, which most meshes are.
#pragma once

#include <optional>

#include "mesh/topology.hpp"

namespace satcheck {

// The result of measure_welded() for the output of weld_and_sort(). Empty unless every edge has two triangles, with
// different corners, that run it in opposite directions.
std::optional<Topology> measure_sorted_manifold(const Mesh& sorted);

}  // namespace satcheck
