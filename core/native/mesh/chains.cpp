#include "mesh/chains.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace satcheck {
namespace {

class Graph {
 public:
  Graph(const std::vector<NodePair>& segments, std::size_t node_count)
      : segments_(segments), used_(segments.size(), false), at_(node_count) {
    for (std::uint32_t s = 0; s < segments.size(); ++s) {
      at_[segments[s].first].push_back(s);
      at_[segments[s].second].push_back(s);
    }
  }

  bool branches(std::uint32_t node) const { return at_[node].size() != 2; }

  // Follows a chain from a node over its first unused segment, through nodes that do not branch.
  Chain follow(std::uint32_t start) {
    Chain chain{{start}, false};
    for (std::uint32_t node = start;;) {
      const auto next = std::find_if(at_[node].begin(), at_[node].end(),
                                     [&](std::uint32_t s) { return !used_[s]; });
      if (next == at_[node].end()) break;
      used_[*next] = true;
      node = segments_[*next].first == node ? segments_[*next].second : segments_[*next].first;
      if (node == start) {
        chain.closed = true;
        break;
      }
      chain.nodes.push_back(node);
      if (branches(node)) break;
    }
    return chain;
  }

  bool has_unused(std::uint32_t node) const {
    return std::any_of(at_[node].begin(), at_[node].end(), [&](std::uint32_t s) { return !used_[s]; });
  }

 private:
  const std::vector<NodePair>& segments_;
  std::vector<bool> used_;
  std::vector<std::vector<std::uint32_t>> at_;
};

}  // namespace

std::vector<Chain> join_chains(const std::vector<NodePair>& segments, std::size_t node_count) {
  Graph graph(segments, node_count);
  std::vector<Chain> chains;
  for (const bool branching : {true, false}) {
    for (std::uint32_t node = 0; node < node_count; ++node) {
      if (graph.branches(node) != branching) continue;
      while (graph.has_unused(node)) chains.push_back(graph.follow(node));
    }
  }
  return chains;
}

std::vector<std::vector<std::uint32_t>> join_loops(std::vector<NodePair> segments) {
  std::sort(segments.begin(), segments.end(), std::greater<>());  // taken from the back
  std::map<std::uint32_t, std::vector<std::uint32_t>> leaving;
  for (const auto& [from, to] : segments) leaving[from].push_back(to);
  std::vector<std::vector<std::uint32_t>> loops;
  for (auto& [start, targets] : leaving) {
    while (!targets.empty()) {
      std::vector<std::uint32_t> path{start};
      std::map<std::uint32_t, std::size_t> place{{start, 0}};
      do {
        std::vector<std::uint32_t>& out = leaving[path.back()];
        if (out.empty()) throw std::logic_error("the segments do not close");
        const std::uint32_t next = out.back();
        out.pop_back();
        const auto [known, is_new] = place.emplace(next, path.size());
        if (is_new) {
          path.push_back(next);
          continue;
        }
        const auto first = path.begin() + static_cast<std::ptrdiff_t>(known->second);
        loops.emplace_back(first, path.end());
        for (auto node = first + 1; node != path.end(); ++node) place.erase(*node);
        path.erase(first + 1, path.end());
      } while (path.size() > 1);
    }
  }
  return loops;
}

}  // namespace satcheck
