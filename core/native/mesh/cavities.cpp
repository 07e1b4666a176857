#include "mesh/cavities.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "exact/exact_point.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/bvh.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

using Around = std::optional<std::vector<std::uint32_t>>;  // components, ascending; empty: undecided

// Measured steps of two triangles, and of a component in a list.
constexpr std::uint64_t kTriangleWork = 30, kListedWork = 5;

class Cavities {
 public:
  Cavities(const Mesh& mesh, const EdgeTable& edges, const Labels& components, Budget* budget)
      : mesh_(mesh), budget_(budget), components_(components), of_triangle_(components.of_triangle),
        members_(components.members()), open_(find_open_sets(components, edges)) {
    for (std::size_t c = 0; c < members_.size(); ++c) volumes_.push_back(open_[c] ? 0 : volume(members_[c]));
  }

  std::vector<std::uint32_t> solids() {
    std::vector<std::uint32_t> solids(members_.size());
    std::iota(solids.begin(), solids.end(), 0);
    const auto [least, most] = std::minmax_element(volumes_.begin(), volumes_.end());
    if (volumes_.empty() || *least >= 0 || *most <= 0) return solids;
    bvh_ = build_bvh(mesh_);
    std::vector<std::pair<std::size_t, std::uint32_t>> walls;  // the outermost first
    for (std::uint32_t c = 0; c < solids.size(); ++c) {
      if (volumes_[c] < 0 && around_of(c)) walls.emplace_back(around_of(c)->size(), c);
    }
    std::sort(walls.begin(), walls.end());
    for (const auto& [_, wall] : walls) {
      if (const auto solid = solid_of(wall, solids)) solids[wall] = *solid;
    }
    return solids;
  }

 private:
  double volume(const std::vector<std::uint32_t>& members) const {
    std::vector<Triangle> triangles;
    for (const std::uint32_t t : members) triangles.push_back(mesh_.triangles[t]);
    return signed_volume(mesh_.vertices, triangles);
  }

  // As brackets are matched: the innermost solid around the wall that no wall around it belongs to. solids: of the walls
  // farther out.
  std::optional<std::uint32_t> solid_of(std::uint32_t wall, const std::vector<std::uint32_t>& solids) {
    const Around around = around_of(wall);
    std::set<std::uint32_t> closed;
    for (const std::uint32_t c : *around) {
      if (volumes_[c] >= 0) continue;
      if (solids[c] == c) return std::nullopt;
      closed.insert(solids[c]);
    }
    std::optional<std::uint32_t> solid;
    for (const std::uint32_t c : *around) {
      spend(budget_, kListedWork * around->size());
      if (volumes_[c] > 0 && !closed.contains(c) && (!solid || depth_of(c) > depth_of(*solid))) solid = c;
    }
    return solid;
  }

  std::size_t depth_of(std::uint32_t component) {
    const Around& around = around_of(component);
    return around ? around->size() : 0;
  }

  const std::vector<std::uint32_t>& crossed(std::uint32_t component) {
    const auto [at, is_new] = crossed_.try_emplace(component);
    if (is_new) at->second = crossed_sets(mesh_, bvh_, components_, component, members_[component], budget_);
    return at->second;
  }

  // The closed components around this one, of those that it does not cross: around one of its points.
  const Around& around_of(std::uint32_t component) {
    const auto [at, is_new] = around_.try_emplace(component);
    if (is_new) at->second = find_around(component);
    return at->second;
  }

  Around find_around(std::uint32_t component) {
    for (const std::uint32_t t : members_[component]) {
      const Corners c = corners(mesh_, t);
      const LazyPoint point = lazy_centroid(c);
      const auto here = triangles_at(mesh_, bvh_, point, {}, budget_);
      if (!std::all_of(here.begin(), here.end(), [&](std::uint32_t u) { return of_triangle_[u] == component; })) continue;
      const Heading first = nearest_wall(bvh_.nodes[0].box, point.rounded);
      for (int attempt = 0; attempt < kMaxSegments; ++attempt) {
        const Vec3 far = outside_point(bvh_.nodes[0].box, point.rounded, first, attempt);
        if (Around around = enclosing(component, point, far)) return around;
      }
    }
    return std::nullopt;
  }

  // Those that the segment passes more often one way than the other. Empty if it meets an edge.
  Around enclosing(std::uint32_t component, const LazyPoint& from, Vec3 far) {
    std::map<std::uint32_t, int> windings;
    const std::vector<std::uint32_t>& besides = crossed(component);
    const auto counts = [&](std::uint32_t t) {
      spend(budget_, kTriangleWork);
      const std::uint32_t other = of_triangle_[t];
      return other != component && !open_[other] && !std::binary_search(besides.begin(), besides.end(), other);
    };
    const auto add = [&](std::uint32_t t, int crossing) { windings[of_triangle_[t]] += crossing; };
    if (!visit_crossings(mesh_, bvh_, from, far, counts, add, budget_)) return std::nullopt;
    std::vector<std::uint32_t> around;
    for (const auto& [c, winding] : windings) {
      if (winding != 0) around.push_back(c);
    }
    return around;
  }

  const Mesh& mesh_;
  Budget* budget_;
  const Labels& components_;
  const std::vector<std::uint32_t>& of_triangle_;
  std::vector<std::vector<std::uint32_t>> members_;
  std::vector<bool> open_;
  std::vector<double> volumes_;  // 0: open
  Bvh bvh_;
  std::map<std::uint32_t, Around> around_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> crossed_;
};

}  // namespace

std::vector<std::uint32_t> crossed_sets(const Mesh& mesh, const Bvh& bvh, const Labels& sets, std::uint32_t set,
                                        const std::vector<std::uint32_t>& members, Budget* budget) {
  std::set<std::uint32_t> crossed;
  for (const std::uint32_t t : members) {
    const Corners mine = corners(mesh, t);
    visit_box(bvh, mesh, bounds_of(mine), [&](std::uint32_t u) {
      spend(budget, kTriangleWork);
      const std::uint32_t other = sets.of_triangle[u];
      if (other == set || crossed.contains(other)) return true;
      if (classify(mine, corners(mesh, u), budget) == TriangleContact::crossing) crossed.insert(other);
      return true;
    }, budget);
  }
  return {crossed.begin(), crossed.end()};
}

std::vector<std::uint32_t> solids_of(const Mesh& welded, const EdgeTable& edges, const Labels& components, Budget* budget) {
  return Cavities(welded, edges, components, budget).solids();
}

}  // namespace satcheck
