#include "overlap/overlap_components.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "base/key_sort.hpp"
#include "base/rounding.hpp"
#include "mesh/self_contact.hpp"
#include "mesh/slivers.hpp"
#include "overlap/passing.hpp"
#include "overlap/shell_labels.hpp"

namespace satcheck {
namespace {

// Measured steps of two boxes, and of a face.
constexpr std::uint64_t kBoxWork = 5, kFaceWork = 500;

// Roundings of a corner of a face and of the operations on it.
constexpr double kVolumeRoundoffs = 16;

class Overlap {
 public:
  explicit Overlap(SpaceCells& cells)
      : cells_(cells), labels_(cells), resolved_(labels_.complete()), joined_(2 * cells.faces().size()) {
    for (std::uint32_t s = 0; s < sides(); ++s) joined_.unite(s, cells.shell(s));
    for (std::uint32_t s = 0; s < sides(); s += 2) {
      if (labels_.in_both(s) && labels_.in_both(s + 1)) joined_.unite(s, s + 1);  // a face within one of the solids
    }
    join_caves();
    component_.assign(sides(), kNoComponent);
    for (std::uint32_t s = 0; s < sides(); ++s) {
      if (labels_.in_both(s)) component_[s] = joined_.find(s);
    }
  }

  OverlapComponents describe(Unresolved unresolved) {
    find_self_contact(unresolved);
    if (is_left_out(unresolved)) return {false, true, {}};
    spend(cells_.budget(), kFaceWork * cells_.faces().size());
    std::map<std::uint32_t, OverlapComponent> found;
    add_faces(found);
    add_volumes(found);
    add_curves(found);
    const auto passing = find_passing(cells_, component_);
    for (auto& [number, component] : found) {
      const auto known = passing.find(number);
      const Passing here = known == passing.end() ? Passing{false, false} : known->second;
      if (!component.resolved) continue;
      component.a_through_b = here.a_through_b;
      component.b_through_a = here.b_through_a;
    }
    OverlapComponents result{resolved_, true, {}};
    for (auto& [_, component] : found) result.components.push_back(std::move(component));
    return result;
  }

 private:
  std::uint32_t sides() const { return static_cast<std::uint32_t>(2 * cells_.faces().size()); }

  // A component within the box of another one may be a cavity of it.
  void join_caves() {
    std::map<std::uint32_t, Aabb> boxes;
    for (std::uint32_t s = 0; s < sides(); ++s) {
      if (labels_.in_both(s)) boxes[joined_.find(s)].include(cells_.box(s / 2));
    }
    for (const auto& [side, box] : boxes) {
      spend(cells_.budget(), kBoxWork * boxes.size());
      const bool may_be_cave = std::any_of(boxes.begin(), boxes.end(), [&, inner = side, &in = box](const auto& other) {
        return other.first != inner && other.second.contains(in);
      });
      if (!may_be_cave) continue;
      const auto pairs = sides_on_way(cells_, side);
      resolved_ = resolved_ && pairs;
      if (!pairs) continue;
      for (const auto& [from, to] : *pairs) joined_.unite(from, to);
    }
  }

  bool is_left_out(Unresolved unresolved) const { return !resolved_ && unresolved == Unresolved::left_out; }

  // Marks self-contacts of triangles that meet the other surface or lie within the other solid.
  void find_self_contact(Unresolved unresolved) {
    irregular_.assign(cells_.faces().size(), false);
    for (std::uint32_t f = 0; f < cells_.faces().size() && !is_left_out(unresolved); ++f) {
      const CellFace& face = cells_.faces()[f];
      const auto in_other = [&](std::uint32_t side) {
        const auto windings = labels_.of(side);
        return windings && (face.mesh == 0 ? windings->b : windings->a) != 0;
      };
      const bool matters = cells_.in_contact(face.mesh, face.triangle) || in_other(2 * f) || in_other(2 * f + 1);
      if (!matters || cells_.bounds_nothing(face)) continue;
      irregular_[f] = face.within > 0 ? irregular_[f - 1]
                                      : has_irregular_partners(cells_.surface(face.mesh), face.triangle, cells_.budget());
      resolved_ = resolved_ && !irregular_[f];
    }
  }

  void add_faces(std::map<std::uint32_t, OverlapComponent>& found) const {
    std::set<std::pair<std::uint32_t, std::uint32_t>> counted;  // components and the first faces of triangles
    for (std::uint32_t s = 0; s < sides(); ++s) {
      if (component_[s] == kNoComponent) continue;
      const std::uint32_t f = s / 2;
      const auto [at, is_new] = found.try_emplace(component_[s]);
      OverlapComponent& component = at->second;
      if (is_new) component.point = cells_.sample(f).rounded;
      for (const Vec3 corner : cells_.face_corners(f)) {
        component.bounds.include(corner);
        component.corners.push_back(corner);
      }
      component.triangles += counted.emplace(component_[s], f - cells_.faces()[f].within).second;
      component.resolved = component.resolved && !irregular_[f];
    }
  }

  // Adds volumes by the divergence theorem, relative to the middle of each component.
  void add_volumes(std::map<std::uint32_t, OverlapComponent>& found) const {
    for (std::uint32_t s = 0; s < sides(); ++s) {
      const CellFace& f = cells_.faces()[s / 2];
      if (component_[s] == kNoComponent || (f.shared && f.mesh == 1)) continue;  // the face of a counts
      OverlapComponent& component = found[component_[s]];
      const Vec3 middle = component.bounds.centre();
      const Vec3 area = cells_.area(s / 2, middle) * (s % 2 == 0 ? -1 : 1);
      component.volume += dot(area, corners(cells_.surface(f.mesh).mesh, f.triangle)[0] - middle) / 3;
      const double largest = component.bounds.largest_coordinate();
      component.volume_error += kVolumeRoundoffs * kUnitRoundoff * largest * norm(area);
    }
  }

  void add_curves(std::map<std::uint32_t, OverlapComponent>& found) const {
    std::map<std::uint32_t, std::vector<NodePair>> segments;
    for (const Wedge& w : cells_.wedges()) {
      const CellFace &f = cells_.faces()[w.side / 2], &g = cells_.faces()[w.other / 2];
      const bool crosses = f.mesh != g.mesh && !f.shared && !g.shared;
      if (crosses && component_[w.side] != kNoComponent) segments[component_[w.side]].emplace_back(w.low, w.high);
    }
    for (auto& [component, pairs] : segments) {
      for (const auto& [low, high] : pairs) {
        found[component].curve_length += norm(cells_.nodes().at(high).rounded - cells_.nodes().at(low).rounded);
      }
      found[component].curves = count_chains(pairs);
    }
  }

  static std::size_t count_chains(std::vector<NodePair> pairs) {
    std::map<std::uint32_t, std::uint32_t> numbers;
    const auto number = [&](std::uint32_t node) {
      return numbers.emplace(node, static_cast<std::uint32_t>(numbers.size())).first->second;
    };
    for (auto& [low, high] : pairs) low = number(low), high = number(high);
    sort_once(pairs);
    return join_chains(pairs, numbers.size()).size();
  }

  SpaceCells& cells_;
  ShellLabels labels_;
  bool resolved_;
  DisjointSets joined_;                   // of sides
  std::vector<std::uint32_t> component_;  // by side
  std::vector<bool> irregular_;           // by face
};

// The solid without collinear triangles, which hide that an edge ends at a vertex.
Surface without_collinear(const Surface& solid) {
  Sliverless sliverless = without_slivers(solid.mesh);
  Surface result(std::make_shared<const Mesh>(std::move(sliverless.mesh)));
  result.solid = true;
  result.bvh = sliverless.changed ? build_bvh(result.mesh) : solid.bvh;
  return result;
}

OverlapComponents components_in_order(const Surface& a, const Surface& b, std::size_t max_pairs, Unresolved unresolved,
                                      Budget* budget) {
  if (!a.solid || !b.solid || a.bvh.nodes.empty() || b.bvh.nodes.empty()) return {false, true, {}};
  const Surface plain_a = without_collinear(a), plain_b = without_collinear(b);
  try {
    SpaceCells cells(plain_a, plain_b, max_pairs, budget);
    if (!cells.complete()) return {false, cells.within_limits(), {}};
    return Overlap(cells).describe(unresolved);
  } catch (const BudgetSpent&) {
    return {false, false, {}};
  }
}

}  // namespace

OverlapComponents overlap_components(const Surface& a, const Surface& b, std::size_t max_pairs, Unresolved unresolved,
                                     Budget* budget) {
  const bool in_order = comes_before(a, b);
  OverlapComponents result = components_in_order(in_order ? a : b, in_order ? b : a, max_pairs, unresolved, budget);
  std::stable_sort(result.components.begin(), result.components.end(), [](const auto& x, const auto& y) {
    return x.bounds.min != y.bounds.min ? coordinates_less(x.bounds.min, y.bounds.min)
                                        : coordinates_less(x.bounds.max, y.bounds.max);
  });
  for (OverlapComponent& component : result.components) {
    if (!in_order) std::swap(component.a_through_b, component.b_through_a);
  }
  return result;
}

std::optional<bool> passes_through(const Surface& a, const Surface& b, std::size_t max_pairs, Budget* budget) {
  const OverlapComponents overlap = overlap_components(a, b, max_pairs, Unresolved::described, budget);
  const auto any = [&](std::optional<bool> answer) {
    return std::any_of(overlap.components.begin(), overlap.components.end(), [&](const OverlapComponent& c) {
      return c.a_through_b == answer || c.b_through_a == answer;
    });
  };
  if (any(true)) return true;
  return overlap.resolved ? std::optional(false) : std::nullopt;
}

}  // namespace satcheck
