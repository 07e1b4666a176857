#include "depth/depth_proof.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "convex/convex_hull.hpp"

namespace satcheck {
namespace {

OverlapSet set_of(const RegionPair& regions, bool turned) {
  const auto& [p, q] = regions;
  OverlapSet set{turned ? q : p, turned ? p : q, {}, {}};
  std::vector<Vec3> differences;
  std::map<std::tuple<double, double, double>, std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t i = 0; i < set.a.vertices.size(); ++i) {
    for (std::uint32_t j = 0; j < set.b.vertices.size(); ++j) {
      const Vec3 d = set.b.vertices[j] - set.a.vertices[i];
      differences.push_back(d);
      pairs.insert({{d.x, d.y, d.z}, {i, j}});
    }
  }
  const HullTriangles hull = hull_triangles(differences);
  std::map<std::uint32_t, std::uint32_t> number;
  for (const Triangle& facet : hull.triangles) {
    Triangle corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [place, is_new] = number.insert({facet[k], static_cast<std::uint32_t>(set.corners.size())});
      const Vec3 d = hull.points[facet[k]];
      if (is_new) set.corners.push_back(pairs.at({d.x, d.y, d.z}));
      corners[k] = place->second;
    }
    set.facets.push_back(corners);
  }
  return set;
}

}  // namespace

std::uint32_t DepthRecord::add() {
  parts_.emplace_back();
  return static_cast<std::uint32_t>(parts_.size() - 1);
}

std::uint32_t DepthRecord::halve(std::uint32_t part) {
  const std::uint32_t first = add();
  add();
  parts_[part] = {DepthProof::kHalved, first};
  return first;
}

DepthProof DepthRecord::proof(double half, const std::vector<RegionPair>& regions, bool turned) const {
  DepthProof proof;
  proof.half = half;
  std::map<int, int> number;
  std::vector<std::uint32_t> pending{0};
  while (!pending.empty()) {
    const Part part = parts_[pending.back()];
    pending.pop_back();
    if (part.kind == DepthProof::kHalved) {
      // Turned, what was below lies above.
      pending.push_back(turned ? part.first : part.first + 1);
      pending.push_back(turned ? part.first + 1 : part.first);
    } else if (part.kind >= 0 && number.insert({part.kind, static_cast<int>(proof.sets.size())}).second) {
      proof.sets.push_back(set_of(regions[static_cast<std::size_t>(part.kind)], turned));
    }
    proof.parts.push_back(part.kind < 0 ? part.kind : number.at(part.kind));
  }
  return proof;
}

}  // namespace satcheck
