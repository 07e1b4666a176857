// Repairs of the winding. Method: two triangles at a shared edge must run it in opposite
// directions; that relation is carried through every patch of edges with exactly two triangles.
#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/patches.hpp"
#include "exact/exact_point.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/boundary.hpp"
#include "mesh/cavities.hpp"
#include "mesh/cracks.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/orient.hpp"
#include "mesh/topology.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

// A set of triangles connected through edges of exactly two triangles.
struct Patch {
  std::vector<std::uint32_t> triangles;
  bool shell = false;  // closed and consistently wound by itself
  bool solid = false;  // it is, or its component as a whole
  bool open = false;   // only fills close it, or its component
  bool turned = false;
  double volume = 0;   // signed; of what is solid with it
  std::uint32_t group = 0;  // the same of what is solid with it
  Aabb box;
  Aabb solid_box;  // of all that is solid with it
};

void flip(Mesh& mesh, Patch& patch) {
  turn(mesh, patch.triangles);
  patch.volume = -patch.volume;
  patch.turned = !patch.turned;
}

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// Whether two triangles that are not copies of each other run their edge in the same direction.
bool run_the_same_way(const Mesh& mesh, const EdgeTable& edges, std::uint32_t h, std::uint32_t twin) {
  const auto across = [&](std::uint32_t half_edge) { return mesh.triangles[half_edge / 3][(half_edge % 3 + 2) % 3]; };
  return edges.ascends(h) == edges.ascends(twin) && across(h) != across(twin);
}

bool has_mixed_winding(const Mesh& mesh, const EdgeTable& edges) {
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    if (h.size() == 2 && run_the_same_way(mesh, edges, h[0], h[1])) return true;
  }
  return false;
}

// Makes patches with mixed winding consistent, with the winding of the majority. A patch that is not orientable does
// not change. Returns whether any triangle was turned, which changes the half-edges.
bool repair_patches(Mesh& mesh, const EdgeTable& edges) {
  if (!has_mixed_winding(mesh, edges)) return false;
  bool repaired = false;
  const std::vector<std::uint32_t> twins = edges.twins();
  enum : signed char { kUnseen, kKeep, kFlip };
  std::vector<signed char> state(mesh.triangles.size(), kUnseen);
  for (const std::vector<std::uint32_t>& patch : label_manifold_patches(mesh, edges).members()) {
    bool orientable = true;
    std::vector<std::uint32_t> queue{patch[0]};
    state[queue[0]] = kKeep;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (std::uint32_t h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
        if (twins[h] == EdgeTable::kNone) continue;
        const std::uint32_t next = twins[h] / 3;
        const bool flips = (state[queue[i]] == kFlip) != run_the_same_way(mesh, edges, h, twins[h]);
        const signed char wanted = flips ? kFlip : kKeep;
        if (state[next] == kUnseen) {
          state[next] = wanted;
          queue.push_back(next);
        }
        orientable = orientable && state[next] == wanted;
      }
    }
    std::vector<std::uint32_t> flipped, kept;
    for (const std::uint32_t t : patch) (state[t] == kFlip ? flipped : kept).push_back(t);
    if (!orientable || flipped.empty()) continue;
    repaired = true;
    for (const std::uint32_t t : flipped.size() <= kept.size() ? flipped : kept) {
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
  }
  return repaired;
}

// A patch is a shell when it runs each of its edges equally often in both directions.
void find_shells(const Mesh& mesh, const EdgeTable& edges, const Labels& labels, std::vector<Patch>& patches) {
  const std::vector<bool> open = find_open_sets(labels, edges);
  for (std::size_t p = 0; p < patches.size(); ++p) patches[p].shell = !open[p];
  for (Patch& patch : patches) {
    std::vector<Triangle> triangles;
    triangles.reserve(patch.triangles.size());
    for (const std::uint32_t t : patch.triangles) {
      triangles.push_back(mesh.triangles[t]);
      patch.box.include(triangle_box(mesh, t));
    }
    if (patch.shell) patch.volume = signed_volume(mesh.vertices, triangles);
  }
}

// The volume of all solids, and of those without fills.
struct Volumes {
  double all = 0, closed = 0;
};

// own: the number of triangles that are no fills.
Volumes find_solids(const Mesh& mesh, std::size_t own, const EdgeTable& edges, std::vector<Patch>& patches) {
  Volumes volumes;
  std::uint32_t number = 0;
  for (Patch& patch : patches) {
    patch.group = number++;
    patch.solid = patch.shell;
    patch.solid_box = patch.box;
    patch.open = patch.triangles.back() >= own;
    volumes.all += patch.volume;
    if (!patch.open) volumes.closed += patch.volume;
  }
  if (std::all_of(patches.begin(), patches.end(), [](const Patch& patch) { return patch.shell; })) return volumes;
  const Labels components = label_components(mesh, edges);
  const std::vector<bool> unbalanced = find_open_sets(components, edges);
  const auto component_of = [&](const Patch& patch) { return components.of_triangle[patch.triangles[0]]; };
  std::vector<Aabb> boxes(components.count);
  std::vector<bool> open(components.count, false);
  std::vector<std::vector<Triangle>> triangles(components.count);  // of solids that are no shells
  for (const Patch& patch : patches) {
    boxes[component_of(patch)].include(patch.box);
    if (patch.open) open[component_of(patch)] = true;
    if (patch.shell || unbalanced[component_of(patch)]) continue;
    for (const std::uint32_t t : patch.triangles) triangles[component_of(patch)].push_back(mesh.triangles[t]);
  }
  std::vector<double> of_component;
  for (std::uint32_t c = 0; c < components.count; ++c) {
    of_component.push_back(signed_volume(mesh.vertices, triangles[c]));
    volumes.all += of_component[c];
    if (!open[c]) volumes.closed += of_component[c];
  }
  for (Patch& patch : patches) {
    const std::uint32_t c = component_of(patch);
    if (patch.shell || unbalanced[c]) continue;
    patch.solid = true;
    patch.solid_box = boxes[c];
    patch.open = open[c];
    patch.volume = of_component[c];
    patch.group = static_cast<std::uint32_t>(patches.size()) + c;
  }
  return volumes;
}

// Measured steps of the boxes of two patches.
constexpr std::uint64_t kBoxWork = 5;

// How a shell lies to the other ones.
class Nesting {
 public:
  // own: the mesh without the fills of its holes, which come last.
  Nesting(const Mesh& mesh, const Mesh& own, const EdgeTable& own_edges, const Labels& labels,
          const std::vector<Patch>& patches, Budget* budget)
      : mesh_(mesh), own_(own), labels_(labels), patches_(patches), budget_(budget), on_rim_(own.triangles.size(), false) {
    for (std::uint32_t p = 0; p < patches.size(); ++p) {
      if (patches[p].solid) solids_.push_back(p);
    }
    for (std::size_t e = 0; e < own_edges.size(); ++e) {
      if (own_edges.half_edges(e).size() == 1) on_rim_[own_edges.half_edges(e)[0] / 3] = true;
    }
  }

  // Whether the shell is inside, or on the surface of, other solids.
  bool is_nested(std::uint32_t patch) { return winding_around(patch, solids_) != 0 && !crosses_another(patch); }

  // Whether the shell is inside others that are turned, and solid there. It then turns with them: a cavity stays one, and
  // so does a solid. turned: shells, ascending.
  bool turns_along(std::uint32_t patch, const std::vector<std::uint32_t>& turned) {
    return winding_around(patch, turned).value_or(0) < 0 && winding_around(patch, solids_).value_or(0) < 0 &&
           !crosses_another(patch);
  }

  // Whether the patch faces inward, and lies in no other solid.
  bool is_inward(std::uint32_t patch) {
    return patches_[patch].solid && patches_[patch].volume < 0 && winding_around(patch, solids_).value_or(0) == 0;
  }

  // Whether the patch faces outward within others that face inward, so that winding numbers cancel. inward: ascending.
  bool is_cancelled(std::uint32_t patch, const std::vector<std::uint32_t>& inward) {
    return patches_[patch].solid && patches_[patch].volume > 0 && winding_around(patch, inward).value_or(-1) < 0;
  }

  // Whether another patch ends near the boundary of this one, by the boxes of triangles. Both may then be pieces of one
  // surface.
  bool ends_near_another(std::uint32_t patch) {
    return !std::all_of(patches_[patch].triangles.begin(), patches_[patch].triangles.end(), [&](std::uint32_t t) {
      return !is_on_rim(t) || visit_box(own_tree(), own_, triangle_box(own_, t), [&](std::uint32_t u) {
        return labels_.of_triangle[u] == patch || !is_on_rim(u);
      }, budget_);
    });
  }

  // Fills are not asked: they may be elsewhere.
  bool crosses_another(std::uint32_t patch) {
    std::vector<std::uint32_t> members = patches_[patch].triangles;
    members.erase(std::lower_bound(members.begin(), members.end(), own_.triangles.size()), members.end());
    return crosses_others(own_, own_tree(), labels_, patch, members, budget_);
  }

 private:
  bool is_on_rim(std::uint32_t triangle) const { return triangle < on_rim_.size() && on_rim_[triangle]; }

  // The winding number of other solids around the shell; none: it lies on their surface. Only solids whose boxes contain it
  // count: those beside it may share all its faces. The box test avoids building the tree if there is none. solids:
  // ascending.
  std::optional<int> winding_around(std::uint32_t patch, const std::vector<std::uint32_t>& solids) {
    const auto may_contain = [&](std::uint32_t other) {
      spend(budget_, kBoxWork);
      return patches_[other].group != patches_[patch].group && patches_[other].solid_box.contains(patches_[patch].box);
    };
    if (std::none_of(solids.begin(), solids.end(), may_contain)) return 0;
    const auto counts = [&](std::uint32_t t) {
      const std::uint32_t other = labels_.of_triangle[t];
      return may_contain(other) && std::binary_search(solids.begin(), solids.end(), other);
    };
    std::optional<int> winding;
    for (const std::uint32_t t : patches_[patch].triangles) {
      const Corners c = corners(mesh_, t);
      if ((winding = winding_number(mesh_, tree(), lazy_centroid(c), counts, budget_))) break;
    }
    return winding;
  }

  const Bvh& tree() {
    if (bvh_.nodes.empty()) bvh_ = build_bvh(mesh_);
    return bvh_;
  }

  const Bvh& own_tree() {
    if (own_bvh_.nodes.empty()) own_bvh_ = build_bvh(own_);
    return own_bvh_;
  }

  const Mesh &mesh_, &own_;
  const Labels& labels_;
  const std::vector<Patch>& patches_;
  Budget* budget_;
  std::vector<std::uint32_t> solids_;  // ascending
  std::vector<bool> on_rim_;
  Bvh bvh_, own_bvh_;
};

std::vector<Patch> make_patches(const Labels& labels) {
  std::vector<Patch> patches;
  for (auto& members : labels.members()) patches.emplace_back().triangles = std::move(members);
  return patches;
}

// Whether triangles run each edge equally often in both directions.
bool is_balanced(const EdgeTable& edges) {
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.balance(e) != 0) return false;
  }
  return true;
}

bool is_closed(const EdgeTable& edges) {
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.half_edges(e).size() % 2 != 0) return false;
  }
  return edges.size() > 0;
}

// Each set of three corners once, in the order of first appearance.
std::vector<Triangle> without_copies(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<Triangle, std::uint32_t>> keyed;
  keyed.reserve(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    Triangle key = triangles[t];
    std::sort(key.begin(), key.end());
    keyed.emplace_back(key, t);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    if (i == 0 || keyed[i].first != keyed[i - 1].first) kept.push_back(keyed[i].second);
  }
  std::sort(kept.begin(), kept.end());
  std::vector<Triangle> result;
  for (const std::uint32_t t : kept) result.push_back(triangles[t]);
  return result;
}

// Drops repeated copies of triangles if the surface is closed only without them.
void drop_surplus(Mesh& welded, std::optional<EdgeTable>& edges) {
  if (is_closed(*edges)) return;
  std::vector<Triangle> single = without_copies(welded.triangles);
  if (single.size() == welded.triangles.size()) return;
  if (!is_closed(EdgeTable(welded.vertices.size(), single))) return;
  welded.triangles = std::move(single);
  edges.emplace(welded.vertices.size(), welded.triangles);
}

// The mesh with its flat open parts doubled, because they are sheets, and its holes filled. Its own triangles come first.
Mesh with_fills(const Mesh& welded, const EdgeTable& edges) {
  Mesh filled = welded;
  if (is_balanced(edges)) return filled;
  double_triangles(filled, flat_parts(welded));
  for (const BoundaryLoop& loop : boundary_loops(filled, EdgeTable(filled.vertices.size(), filled.triangles))) {
    const std::vector<Triangle> fill = fan(loop);
    filled.triangles.insert(filled.triangles.end(), fill.begin(), fill.end());
  }
  return filled;
}

// If a shell that faces inward crosses others, winding numbers cancel, and the volume inside both would not be material. An
// open one is turned only in this case, and only if it is not a piece of a larger surface.
bool has_to_turn(std::uint32_t p, const Patch& patch, Nesting& nesting) {
  if (!patch.shell || !(patch.volume < 0)) return false;
  return patch.open ? nesting.crosses_another(p) && !nesting.ends_near_another(p) : !nesting.is_nested(p);
}

// Turns shells that face inward, with all that lies within them. Returns the doubtful patches.
std::vector<std::uint32_t> turn_shells(Mesh& mesh, std::vector<Patch>& patches, Nesting& nesting) {
  std::vector<std::uint32_t> turned, closed;
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    if (!has_to_turn(p, patches[p], nesting)) continue;
    turned.push_back(p);
    if (!patches[p].open) closed.push_back(p);
  }
  for (std::uint32_t p = 0; !closed.empty() && p < patches.size(); ++p) {
    const bool stays = patches[p].shell && !std::binary_search(turned.begin(), turned.end(), p);
    if (stays && nesting.turns_along(p, closed)) turned.push_back(p);
  }
  for (const std::uint32_t p : turned) flip(mesh, patches[p]);
  std::vector<std::uint32_t> inward, doubtful;
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    if (nesting.is_inward(p)) inward.push_back(p);
  }
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    // It has become the wall of a cavity because what lies around it was turned.
    const bool is_wall = patches[p].solid && patches[p].turned && patches[p].volume < 0;
    if ((is_wall && !std::binary_search(inward.begin(), inward.end(), p)) || nesting.is_cancelled(p, inward)) doubtful.push_back(p);
  }
  return doubtful;
}

Facing facing_in(const Mesh& mesh, const EdgeTable& own_edges, Budget* budget) {
  Mesh filled = with_fills(mesh, own_edges);
  const std::size_t own = mesh.triangles.size();
  std::optional<EdgeTable> of_filled;
  const EdgeTable& edges =
      filled.triangles.size() == own ? own_edges : of_filled.emplace(filled.vertices.size(), filled.triangles);
  const Labels labels = label_manifold_patches(filled, edges);
  std::vector<Patch> patches = make_patches(labels);
  find_shells(filled, edges, labels, patches);
  const Volumes volumes = find_solids(filled, own, edges, patches);
  if (volumes.all < 0 && volumes.closed < 0) {
    for (Patch& patch : patches) flip(filled, patch);
  } else if (std::none_of(patches.begin(), patches.end(), [](const Patch& patch) { return patch.volume < 0; })) {
    return {};
  }
  Nesting nesting(filled, mesh, own_edges, labels, patches, budget);
  std::map<std::uint32_t, std::vector<std::uint32_t>> doubtful;  // by group
  const auto add_own = [&](std::vector<std::uint32_t>& to, const Patch& patch) {
    std::copy_if(patch.triangles.begin(), patch.triangles.end(), std::back_inserter(to), [&](auto t) { return t < own; });
  };
  for (const std::uint32_t p : turn_shells(filled, patches, nesting)) add_own(doubtful[patches[p].group], patches[p]);
  Facing facing;
  for (auto& [group, triangles] : doubtful) facing.doubtful.push_back(std::move(triangles));
  for (const Patch& patch : patches) {
    if (patch.turned) add_own(facing.inward, patch);
  }
  return facing;
}

}  // namespace

void turn(Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  for (const std::uint32_t t : triangles) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
}

Mesh orient(const Mesh& mesh, Budget* budget, bool* doubtful) {
  Mesh result = weld(mesh);
  std::optional<EdgeTable> edges(std::in_place, result.vertices.size(), result.triangles);
  drop_surplus(result, edges);
  if (repair_patches(result, *edges)) edges.emplace(result.vertices.size(), result.triangles);
  const Facing facing = facing_in(result, *edges, budget);
  if (facing.doubtful.empty()) turn(result, facing.inward);
  if (doubtful != nullptr) *doubtful = !facing.doubtful.empty();
  return result;
}

Facing facing_of(const Mesh& welded, Budget* budget) {
  return facing_in(welded, EdgeTable(welded.vertices.size(), welded.triangles), budget);
}

std::vector<Mesh> split_components(const Mesh& mesh, double crack_width, const Poll& poll) {
  const Mesh welded = weld(mesh);
  Mesh sealed = welded;
  Budget budget = Budget::that_stops(kNoEnd, poll);
  if (crack_width > 0) seal_cracks(sealed, crack_width, &budget);
  const EdgeTable edges(sealed.vertices.size(), sealed.triangles);
  std::vector<Mesh> result;
  std::vector<std::uint32_t> place(welded.vertices.size());
  std::vector<std::uint32_t> part_of(welded.vertices.size(), none);
  Labels labels = label_components(sealed, edges);
  // What is a cavity, or may be one, shows where the mesh faces outward. The parts themselves stay as they are.
  Mesh outward = orient(sealed, &budget);
  turn(outward, facing_of(outward, &budget).inward);
  if (outward.triangles.size() != sealed.triangles.size()) outward = sealed;  // without copies
  const EdgeTable outward_edges(outward.vertices.size(), outward.triangles);
  const std::vector<std::uint32_t> solids = solids_of(outward, outward_edges, labels, &budget);
  for (std::uint32_t& label : labels.of_triangle) label = solids[label];
  for (const auto& members : labels.members()) {
    if (members.empty()) continue;  // they bound a cavity
    const auto part_number = static_cast<std::uint32_t>(result.size());
    Mesh& part = result.emplace_back();
    for (const std::uint32_t t : members) {
      if (t >= welded.triangles.size()) break;  // it closes a crack
      Triangle corners = welded.triangles[t];
      for (std::uint32_t& v : corners) {
        if (part_of[v] != part_number) {
          part_of[v] = part_number;
          place[v] = static_cast<std::uint32_t>(part.vertices.size());
          part.vertices.push_back(welded.vertices[v]);
        }
        v = place[v];
      }
      part.triangles.push_back(corners);
    }
  }
  return result;
}

}  // namespace satcheck
