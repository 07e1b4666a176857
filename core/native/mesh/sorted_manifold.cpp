// Edges are listed at their lower corner. Of a triangle two edges start or end at its lowest corner, and the triangles
// of a corner follow each other: only the third edges have to be distributed.
#include "mesh/sorted_manifold.hpp"

#include <algorithm>
#include <memory>
#include <numeric>

#include "base/key_sort.hpp"
#include "base/large_pages.hpp"
#include "base/patches.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// A half-edge at its lower corner: the upper corner, whether it ascends, the triangle.
using Side = std::uint64_t;
constexpr std::uint32_t kAscends = 0x80000000;

Side make_side(std::uint32_t upper, bool ascends, std::uint32_t triangle) {
  return Side{upper} << 32 | (ascends ? kAscends : 0) | triangle;
}
std::uint32_t upper(Side side) { return static_cast<std::uint32_t>(side >> 32); }
bool ascends(Side side) { return (side & kAscends) != 0; }
std::uint32_t triangle(Side side) { return static_cast<std::uint32_t>(side) & ~kAscends; }

// The sides across from the lowest corners.
class ThirdSides {
 public:
  ThirdSides(std::size_t vertex_count, const std::vector<Triangle>& triangles)
      : start_(vertex_count + 1), sides_(unwritten<Side>(triangles.size())) {
    for (const Triangle& t : triangles) ++start_[std::min(t[1], t[2])];
    std::inclusive_scan(start_.begin(), start_.end(), start_.begin());
    // From the back, so that each start ends up where its list starts.
    for (std::size_t t = triangles.size(); t-- > 0;) {
      const auto [a, b, c] = triangles[t];
      sides_[--start_[std::min(b, c)]] = make_side(std::max(b, c), b < c, static_cast<std::uint32_t>(t));
    }
  }

  std::span<const Side> of(std::size_t vertex) const {
    return {sides_.get() + start_[vertex], sides_.get() + start_[vertex + 1]};
  }

 private:
  std::vector<std::uint32_t> start_;
  std::unique_ptr<Side[]> sides_;
};

// Unites the triangles on either side of each edge of a list; -1 where an edge has not two that fit, else how many
// were not yet connected.
std::ptrdiff_t pair_up(std::vector<Side>& sides, const std::vector<Triangle>& triangles, DisjointSets& sets) {
  sort_list(sides.data(), sides.data() + sides.size());
  if (sides.size() % 2 != 0) return -1;
  std::ptrdiff_t united = 0;
  for (std::size_t i = 0; i < sides.size(); i += 2) {
    const Side one = sides[i], other = sides[i + 1];
    if (upper(one) != upper(other) || ascends(one) || !ascends(other)) return -1;
    if (i > 0 && upper(sides[i - 1]) == upper(one)) return -1;
    // They share two corners, so these sums tell whether the third ones differ.
    const auto corner_sum = [&](Side side) {
      const Triangle& t = triangles[triangle(side)];
      return std::uint64_t{t[0]} + t[1] + t[2];
    };
    if (corner_sum(one) == corner_sum(other)) return -1;
    united += sets.unite(triangle(one), triangle(other)) ? 1 : 0;
  }
  return united;
}

}  // namespace

std::optional<Topology> measure_sorted_manifold(const Mesh& sorted) {
  const std::vector<Triangle>& triangles = sorted.triangles;
  if (triangles.empty() || triangles.size() >= kAscends) return std::nullopt;
  if (std::any_of(triangles.begin(), triangles.end(), repeats_a_corner)) return std::nullopt;
  const ThirdSides thirds(sorted.vertices.size(), triangles);
  DisjointSets sets(triangles.size());
  Topology topology;
  topology.vertices = sorted.vertices.size();
  topology.triangles = topology.components = triangles.size();
  std::vector<Side> sides;
  std::uint32_t t = 0;
  for (std::uint32_t v = 0; v < sorted.vertices.size(); ++v) {
    const auto third = thirds.of(v);
    sides.assign(third.begin(), third.end());
    for (; t < triangles.size() && triangles[t][0] == v; ++t) {
      sides.push_back(make_side(triangles[t][1], true, t));
      sides.push_back(make_side(triangles[t][2], false, t));
    }
    const std::ptrdiff_t united = pair_up(sides, triangles, sets);
    if (united < 0) return std::nullopt;
    topology.components -= static_cast<std::size_t>(united);
  }
  topology.closed = topology.manifold = topology.oriented = true;
  for (const Triangle& corner : triangles) {
    const bool flat = collinear(sorted.vertices[corner[0]], sorted.vertices[corner[1]], sorted.vertices[corner[2]]);
    topology.degenerate_triangles += flat ? 1 : 0;
  }
  topology.volume = signed_volume(sorted.vertices, triangles);
  topology.solid = topology.volume != 0;
  return topology;
}

}  // namespace satcheck
