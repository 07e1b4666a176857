// Repairs of the winding. Method: two triangles at a shared edge must run it in opposite
// directions; that relation is carried through every patch of edges with exactly two triangles.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/patches.hpp"
#include "mesh/cavities.hpp"
#include "mesh/cracks.hpp"
#include "mesh/facing.hpp"
#include "mesh/orient.hpp"
#include "mesh/topology.hpp"

namespace satcheck {
namespace {

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
        if (twins[h] == kNoIndex) continue;
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

}  // namespace

Mesh orient(const Mesh& mesh, Budget* budget, bool* doubtful) {
  Mesh result = weld(mesh);
  std::optional<EdgeTable> edges(std::in_place, result.vertices.size(), result.triangles);
  drop_surplus(result, edges);
  if (repair_patches(result, *edges)) edges.emplace(result.vertices.size(), result.triangles);
  const Facing facing = facing_of(result, *edges, budget);
  if (facing.doubtful.empty()) turn(result, facing.inward);
  if (doubtful != nullptr) *doubtful = !facing.doubtful.empty();
  return result;
}

std::vector<Mesh> split_components(const Mesh& mesh, double crack_width, const Poll& poll) {
  const Mesh welded = weld(mesh);
  Mesh sealed = welded;
  Budget budget = Budget::that_stops(kNoEnd, poll);
  if (crack_width > 0) seal_cracks(sealed, crack_width, &budget);
  const EdgeTable edges(sealed.vertices.size(), sealed.triangles);
  std::vector<Mesh> result;
  std::vector<std::uint32_t> place(welded.vertices.size());
  std::vector<std::uint32_t> part_of(welded.vertices.size(), kNoIndex);
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
