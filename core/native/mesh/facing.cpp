// Method: holes are filled, so that each part is a shell or a solid of several; signed volumes tell how each faces, and
// winding numbers of the others around it how they nest.
#include "mesh/facing.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/patches.hpp"
#include "exact/exact_point.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/boundary.hpp"
#include "mesh/cavities.hpp"
#include "mesh/mesh_checks.hpp"
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

// How a patch lies to the other ones.
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

  // Whether the patch is inside, or on the surface of, other solids that it does not cross.
  bool is_within(std::uint32_t patch) { return winding_within(patch, solids_) != 0; }

  // Whether the patch faces inward within others, and crosses another one that does. In both, winding numbers may cancel.
  bool is_crossed_wall(std::uint32_t patch) {
    const auto is_wall = [&](std::uint32_t p) { return patches_[p].solid && patches_[p].volume < 0 && is_within(p); };
    return is_wall(patch) && std::any_of(crossed(patch).begin(), crossed(patch).end(), [&](std::uint32_t other) {
      return patches_[other].group != patches_[patch].group && is_wall(other);
    });
  }

  // Whether the patch is inside others that are turned, and solid there; those that it crosses do not count. It then turns
  // with them: a cavity stays one, and so does a solid. turned: shells, ascending.
  bool turns_along(std::uint32_t patch, const std::vector<std::uint32_t>& turned) {
    return winding_within(patch, turned).value_or(0) < 0 && winding_within(patch, solids_).value_or(0) < 0;
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

  // The other patches that the patch crosses. Fills are not asked: they may be elsewhere.
  const std::vector<std::uint32_t>& crossed(std::uint32_t patch) {
    const auto [at, is_new] = crossed_.try_emplace(patch);
    if (is_new) {
      std::vector<std::uint32_t> members = patches_[patch].triangles;
      members.erase(std::lower_bound(members.begin(), members.end(), own_.triangles.size()), members.end());
      at->second = crossed_sets(own_, own_tree(), labels_, patch, members, budget_);
    }
    return at->second;
  }

 private:
  // The winding number around the patch of those solids that it does not cross.
  std::optional<int> winding_within(std::uint32_t patch, std::vector<std::uint32_t> solids) {
    std::set<std::uint32_t> groups;
    for (const std::uint32_t other : crossed(patch)) groups.insert(patches_[other].group);
    std::erase_if(solids, [&](std::uint32_t other) { return groups.contains(patches_[other].group); });
    return winding_around(patch, solids);
  }

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
  std::map<std::uint32_t, std::vector<std::uint32_t>> crossed_;  // by patch
};

std::vector<Patch> make_patches(const Labels& labels) {
  std::vector<Patch> patches;
  for (auto& members : labels.members()) patches.emplace_back().triangles = std::move(members);
  return patches;
}

// The mesh with its flat open parts doubled, because they are sheets, and its holes filled. Its own triangles come first.
Mesh with_fills(const Mesh& welded, const EdgeTable& edges) {
  Mesh filled = welded;
  if (edges.is_balanced()) return filled;
  double_triangles(filled, flat_parts(welded));
  for (const BoundaryLoop& loop : boundary_loops(filled)) {
    const std::vector<Triangle> fill = fan(loop);
    filled.triangles.insert(filled.triangles.end(), fill.begin(), fill.end());
  }
  return filled;
}

// The patches of a solid, ascending.
using Solid = std::vector<std::uint32_t>;

// If a solid that faces inward crosses others, winding numbers cancel, and the volume inside both would not be material. An
// open shell is turned only in this case, and only if it is not a piece of a larger surface.
bool has_to_turn(const Solid& solid, const std::vector<Patch>& patches, Nesting& nesting) {
  const Patch& first = patches[solid[0]];
  if (!(first.volume < 0) || (first.open && !first.shell)) return false;
  if (first.open) return !nesting.crossed(solid[0]).empty() && !nesting.ends_near_another(solid[0]);
  return !std::all_of(solid.begin(), solid.end(), [&](std::uint32_t p) { return nesting.is_within(p); });
}

// Turns solids that face inward, with all that lies within them. Returns the doubtful patches.
std::vector<std::uint32_t> turn_solids(Mesh& mesh, std::vector<Patch>& patches, Nesting& nesting) {
  std::map<std::uint32_t, Solid> solids;  // by group
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    if (patches[p].solid) solids[patches[p].group].push_back(p);
  }
  Solid turned, closed, along, inward, doubtful;
  const auto is_in = [](const Solid& set, std::uint32_t p) { return std::binary_search(set.begin(), set.end(), p); };
  for (const auto& [group, solid] : solids) {
    if (!has_to_turn(solid, patches, nesting)) continue;
    turned.insert(turned.end(), solid.begin(), solid.end());
    if (!patches[solid[0]].open) closed.insert(closed.end(), solid.begin(), solid.end());
  }
  std::sort(turned.begin(), turned.end());
  std::sort(closed.begin(), closed.end());
  for (const auto& [group, solid] : solids) {
    if (closed.empty() || is_in(turned, solid[0]) || (patches[solid[0]].open && !patches[solid[0]].shell)) continue;
    const auto turns = [&](std::uint32_t p) { return nesting.turns_along(p, closed); };
    if (std::all_of(solid.begin(), solid.end(), turns)) along.insert(along.end(), solid.begin(), solid.end());
  }
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    if (!is_in(turned, p) && nesting.is_crossed_wall(p)) doubtful.push_back(p);
  }
  for (const std::uint32_t p : turned) flip(mesh, patches[p]);
  for (const std::uint32_t p : along) flip(mesh, patches[p]);
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    if (nesting.is_inward(p)) inward.push_back(p);
  }
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    // It has become the wall of a cavity because what lies around it was turned.
    const bool is_wall = patches[p].solid && patches[p].turned && patches[p].volume < 0 && !is_in(inward, p);
    if (is_wall || nesting.is_cancelled(p, inward)) doubtful.push_back(p);
  }
  return doubtful;
}

}  // namespace

Facing facing_of(const Mesh& mesh, const EdgeTable& own_edges, Budget* budget) {
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
  for (const std::uint32_t p : turn_solids(filled, patches, nesting)) add_own(doubtful[patches[p].group], patches[p]);
  Facing facing;
  for (auto& [group, triangles] : doubtful) facing.doubtful.push_back(std::move(triangles));
  for (const Patch& patch : patches) {
    if (patch.turned) add_own(facing.inward, patch);
  }
  return facing;
}

Facing facing_of(const Mesh& welded, Budget* budget) {
  return facing_of(welded, EdgeTable(welded.vertices.size(), welded.triangles), budget);
}

void turn(Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  for (const std::uint32_t t : triangles) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
}

}  // namespace satcheck
