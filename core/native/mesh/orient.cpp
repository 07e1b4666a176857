// Repairs of the winding. Method: two triangles at a shared edge must run it in opposite
// directions; that relation is carried through every patch of edges with exactly two triangles.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "base/patches.hpp"
#include "exact/exact_point.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
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
  std::vector<std::uint32_t> triangles, on_rim;
  bool shell = false;  // closed and consistently wound by itself
  bool solid = false;  // it is, or its component as a whole
  bool alone = true;   // shares no edge with another patch, so that it can be turned by itself
  bool turned = false;
  double volume = 0;   // signed; of an open patch, closed by a cone over its boundary
  Aabb box, rim;
  Aabb solid_box;  // of all that is solid with it
};

void flip(Mesh& mesh, Patch& patch) {
  for (const std::uint32_t t : patch.triangles) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
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
bool repair_patches(Mesh& mesh, const EdgeTable& edges, const std::vector<Patch>& patches) {
  if (!has_mixed_winding(mesh, edges)) return false;
  bool repaired = false;
  const std::vector<std::uint32_t> twins = edges.twins();
  enum : signed char { kUnseen, kKeep, kFlip };
  std::vector<signed char> state(mesh.triangles.size(), kUnseen);
  for (const Patch& patch : patches) {
    bool orientable = true;
    std::vector<std::uint32_t> queue{patch.triangles[0]};
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
    for (const std::uint32_t t : patch.triangles) (state[t] == kFlip ? flipped : kept).push_back(t);
    if (!orientable || flipped.empty()) continue;
    repaired = true;
    for (const std::uint32_t t : flipped.size() <= kept.size() ? flipped : kept) {
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
  }
  return repaired;
}

// The volume between the patch and the centre of its boundary. Rounded.
double volume_over_rim(const Mesh& mesh, const Patch& patch) {
  const Vec3 centre = (patch.rim.min + patch.rim.max) * 0.5;
  double sum = 0;
  for (const std::uint32_t t : patch.triangles) {
    const Triangle& v = mesh.triangles[t];
    const Vec3 p = mesh.vertices[v[0]] - centre, q = mesh.vertices[v[1]] - centre, r = mesh.vertices[v[2]] - centre;
    sum += dot(p, cross(q, r));
  }
  return sum / 6;
}

void find_rims(const Mesh& mesh, const EdgeTable& edges, const Labels& labels, std::vector<Patch>& patches) {
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto half_edges = edges.half_edges(e);
    if (half_edges.size() == 2) continue;
    for (const std::uint32_t h : half_edges) {
      Patch& patch = patches[labels.of_triangle[h / 3]];
      patch.alone = patch.alone && half_edges.size() == 1;
      patch.on_rim.push_back(h / 3);
      for (int i = 0; i < 2; ++i) patch.rim.include(mesh.vertices[mesh.triangles[h / 3][(h % 3 + i) % 3]]);
    }
  }
}

// A patch is a shell when it runs each of its edges equally often in both directions.
void find_shells(const Mesh& mesh, const EdgeTable& edges, const Labels& labels, std::vector<Patch>& patches) {
  const std::vector<bool> open = find_open_sets(labels, edges);
  for (std::size_t p = 0; p < patches.size(); ++p) patches[p].shell = !open[p];
  find_rims(mesh, edges, labels, patches);
  for (Patch& patch : patches) {
    std::vector<Triangle> triangles;
    triangles.reserve(patch.triangles.size());
    for (const std::uint32_t t : patch.triangles) {
      triangles.push_back(mesh.triangles[t]);
      patch.box.include(triangle_box(mesh, t));
    }
    patch.volume = patch.shell ? signed_volume(mesh.vertices, triangles) : volume_over_rim(mesh, patch);
  }
}

// Returns the volume of all solids.
double find_solids(const Mesh& mesh, const EdgeTable& edges, std::vector<Patch>& patches) {
  double volume = 0;
  for (Patch& patch : patches) {
    patch.solid = patch.shell;
    patch.solid_box = patch.box;
    if (patch.shell) volume += patch.volume;
  }
  if (std::all_of(patches.begin(), patches.end(), [](const Patch& patch) { return patch.shell; })) return volume;
  const Labels components = label_components(mesh, edges);
  const std::vector<bool> open = find_open_sets(components, edges);
  const auto component_of = [&](const Patch& patch) { return components.of_triangle[patch.triangles[0]]; };
  std::vector<Aabb> boxes(components.count);
  for (const Patch& patch : patches) boxes[component_of(patch)].include(patch.box);
  std::vector<Triangle> others;  // of solids that are no shells
  for (Patch& patch : patches) {
    if (patch.shell || open[component_of(patch)]) continue;
    patch.solid = true;
    patch.solid_box = boxes[component_of(patch)];
    for (const std::uint32_t t : patch.triangles) others.push_back(mesh.triangles[t]);
  }
  return volume + signed_volume(mesh.vertices, others);
}

// Measured steps of the boxes of two patches.
constexpr std::uint64_t kBoxWork = 5;

// How a patch lies to the other ones.
class Nesting {
 public:
  Nesting(const Mesh& mesh, const Labels& labels, const std::vector<Patch>& patches, Budget* budget)
      : mesh_(mesh), labels_(labels), patches_(patches), budget_(budget), on_rim_(mesh.triangles.size(), false) {
    for (std::uint32_t p = 0; p < patches.size(); ++p) {
      if (patches[p].solid) solids_.push_back(p);
      for (const std::uint32_t t : patches[p].on_rim) on_rim_[t] = true;
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

  // Whether another patch ends near the boundary of this one, by the boxes of triangles. Both may then be pieces of one
  // surface.
  bool ends_near_another(std::uint32_t patch) {
    const auto& ends = patches_[patch].on_rim;
    return std::any_of(ends.begin(), ends.end(), [&](std::uint32_t t) {
      return !visit_box(tree(), mesh_, triangle_box(mesh_, t),
                        [&](std::uint32_t u) { return labels_.of_triangle[u] == patch || !on_rim_[u]; }, budget_);
    });
  }

  bool crosses_another(std::uint32_t patch) {
    return crosses_others(mesh_, tree(), labels_, patch, patches_[patch].triangles, budget_);
  }

 private:
  // The winding number of other solids around the shell; none: it lies on their surface. Only solids whose boxes contain it
  // count: those beside it may share all its faces. The box test avoids building the tree if there is none. solids:
  // ascending.
  std::optional<int> winding_around(std::uint32_t patch, const std::vector<std::uint32_t>& solids) {
    const auto may_contain = [&](std::uint32_t other) {
      spend(budget_, kBoxWork);
      return other != patch && patches_[other].solid_box.contains(patches_[patch].box);
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

  const Mesh& mesh_;
  const Labels& labels_;
  const std::vector<Patch>& patches_;
  Budget* budget_;
  std::vector<std::uint32_t> solids_;  // ascending
  std::vector<bool> on_rim_;
  Bvh bvh_;
};

// If a patch that faces inward crosses others, winding numbers cancel, and the volume inside both would not be
// material. An open patch is turned only in this case, and only if it is not a piece of a larger surface.
bool has_to_turn(const Mesh& mesh, const std::vector<Patch>& patches, std::uint32_t p, Nesting& nesting) {
  const Patch& patch = patches[p];
  if (!(patch.volume < 0)) return false;
  if (patch.shell) return !nesting.is_nested(p);
  if (!patch.alone || is_flat(mesh, patch.triangles)) return false;
  return !nesting.ends_near_another(p) && nesting.crosses_another(p);
}

std::vector<Patch> make_patches(const Labels& labels) {
  std::vector<Patch> patches;
  for (auto& members : labels.members()) patches.emplace_back().triangles = std::move(members);
  return patches;
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

// Turns the patches that face inward, with all that lies within them. volume: of all solids.
void turn_outward(Mesh& mesh, double volume, const Labels& labels, std::vector<Patch>& patches, Budget* budget) {
  if (volume < 0) {
    for (Patch& patch : patches) flip(mesh, patch);
  }
  Nesting nesting(mesh, labels, patches, budget);
  std::vector<std::uint32_t> inside_out, shells;
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    if (!has_to_turn(mesh, patches, p, nesting)) continue;
    inside_out.push_back(p);
    if (patches[p].shell) shells.push_back(p);
  }
  for (std::uint32_t p = 0; !shells.empty() && p < patches.size(); ++p) {
    const bool stays = patches[p].shell && !std::binary_search(shells.begin(), shells.end(), p);
    if (stays && nesting.turns_along(p, shells)) inside_out.push_back(p);
  }
  for (const std::uint32_t p : inside_out) flip(mesh, patches[p]);
}

// Whether it has become the wall of a cavity because what lies around it was turned.
bool is_doubtful(const Patch& patch) { return patch.shell && patch.turned && patch.volume < 0; }

}  // namespace

Mesh orient(const Mesh& mesh, Budget* budget, bool* doubtful) {
  Mesh result = weld(mesh);
  std::optional<EdgeTable> edges(std::in_place, result.vertices.size(), result.triangles);
  drop_surplus(result, edges);
  const Labels labels = label_manifold_patches(result, *edges);
  std::vector<Patch> patches = make_patches(labels);
  if (repair_patches(result, *edges, patches)) edges.emplace(result.vertices.size(), result.triangles);
  find_shells(result, *edges, labels, patches);
  Mesh outward = result;
  turn_outward(outward, find_solids(result, *edges, patches), labels, patches, budget);
  if (std::none_of(patches.begin(), patches.end(), is_doubtful)) return outward;
  if (doubtful != nullptr) *doubtful = true;
  return result;
}

std::optional<Doubt> find_doubt(const Mesh& welded, Budget* budget) {
  const EdgeTable edges(welded.vertices.size(), welded.triangles);
  const Labels labels = label_manifold_patches(welded, edges);
  std::vector<Patch> patches = make_patches(labels);
  if (patches.size() == 1) return std::nullopt;
  find_shells(welded, edges, labels, patches);
  const double volume = find_solids(welded, edges, patches);
  const auto a_shell_faces = [&](double way) {
    return std::any_of(patches.begin(), patches.end(), [&](const Patch& p) { return p.shell && way * p.volume > 0; });
  };
  if (!a_shell_faces(1) || !(volume < 0 || a_shell_faces(-1))) return std::nullopt;
  Doubt doubt{welded, {}};
  turn_outward(doubt.outward, volume, labels, patches, budget);
  for (const Patch& patch : patches) {
    if (is_doubtful(patch)) doubt.shells.push_back(patch.triangles);
  }
  return doubt.shells.empty() ? std::nullopt : std::optional(std::move(doubt));
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
  if (const auto doubt = find_doubt(outward, &budget)) outward = doubt->outward;
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
