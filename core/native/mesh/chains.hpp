// Segments between numbered nodes, joined into the longest chains that do not branch, and into loops.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace satcheck {

using NodePair = std::pair<std::uint32_t, std::uint32_t>;

struct Chain {
  std::vector<std::uint32_t> nodes;  // a closed chain does not repeat its first node
  bool closed = false;
};

// Joins undirected segments, each given once. A chain ends at a node where the number of segments is not two.
std::vector<Chain> join_chains(const std::vector<NodePair>& segments, std::size_t node_count);

// Joins directed segments into loops. At each node as many enter as leave. No loop passes a node twice. Throws
// std::logic_error if they do not close.
std::vector<std::vector<std::uint32_t>> join_loops(std::vector<NodePair> segments);

}  // namespace satcheck
