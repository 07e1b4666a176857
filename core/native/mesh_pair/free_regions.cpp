#include "mesh_pair/free_regions.hpp"

#include <algorithm>
#include <utility>

#include "base/patches.hpp"
#include "exact/predicates.hpp"
#include "mesh/self_contact.hpp"

namespace satcheck {
namespace {

// Measured steps of joining a triangle to its neighbours.
constexpr std::uint64_t kJoinWork = 10;

template <class IsFree>
DisjointSets connect_corners(const Mesh& mesh, IsFree is_free, Budget* budget) {
  spend(budget, kJoinWork * mesh.triangles.size());
  DisjointSets sets(mesh.vertices.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!is_free(t)) continue;
    sets.unite(mesh.triangles[t][0], mesh.triangles[t][1]);
    sets.unite(mesh.triangles[t][0], mesh.triangles[t][2]);
  }
  return sets;
}

}  // namespace

FreeRegions::FreeRegions(const Side& side, std::vector<bool> in_contact)
    : side_(side), in_contact_(std::move(in_contact)) {
  const Mesh& mesh = side_.self.mesh;
  if (in_contact_.empty()) {
    for (const std::uint32_t triangle : side_.self.parts) add(triangle);
    return;
  }
  DisjointSets sets = connect_corners(mesh, [&](std::uint32_t t) { return is_free(t); }, side_.budget);
  std::vector<bool> known(mesh.vertices.size(), false);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!is_free(t)) continue;
    const std::uint32_t set = sets.find(mesh.triangles[t][0]);
    if (!known[set]) add(t);
    known[set] = true;
  }
}

void FreeRegions::add(std::uint32_t triangle) {
  const Mesh& mesh = side_.self.mesh;
  const auto theirs = winding_number(side_.other, mesh.vertices[mesh.triangles[triangle][0]], side_.budget);
  known_ = known_ && theirs.has_value();
  regions_.push_back({triangle, theirs.value_or(0)});
}

bool FreeRegions::any_inside() const {
  return std::any_of(regions_.begin(), regions_.end(), [](const Region& r) { return r.theirs != 0; });
}

void FreeRegions::sample_first(Samples& samples) const {
  if (!known_) samples.fail();
  for (const Region& region : regions_) {
    if (!samples.may_learn(side_, region.theirs) || is_collinear(corners(side_.self.mesh, region.triangle))) continue;
    sample_centre(region.triangle, region.theirs, samples);
  }
}

void FreeRegions::sample_rest(Samples& samples) const {
  const auto may_learn = [&](const Region& region) { return samples.may_learn(side_, region.theirs); };
  if (std::any_of(regions_.begin(), regions_.end(), may_learn)) sample_every_piece(samples);
}

bool FreeRegions::sample_centre(std::uint32_t t, int theirs, Samples& samples) const {
  const Corners c = corners(side_.self.mesh, t);
  const ExactPoint p = weighted_point(c[0], c[1], c[2], 1.0, 1.0, 1.0);
  const auto mine = winding_beside(side_.self.mesh, side_.self.bvh, p, c[0], c[1], c[2], {}, side_.budget);
  return samples.note_point(side_, t, kNoIndex, p, mine, Beside{theirs, theirs});
}

void FreeRegions::sample_every_piece(Samples& samples) const {
  const Mesh& mesh = side_.self.mesh;
  DisjointSets sets = connect_corners(mesh, [&](std::uint32_t t) { return is_free(t); }, side_.budget);
  std::vector<int> theirs_of_set(mesh.vertices.size(), 0);
  for (const Region& region : regions_) {
    theirs_of_set[sets.find(mesh.triangles[region.triangle][0])] = region.theirs;
  }
  const auto theirs = [&](std::uint32_t t) { return theirs_of_set[sets.find(mesh.triangles[t][0])]; };
  const auto wanted = [&](std::uint32_t t) { return is_free(t) && samples.may_learn(side_, theirs(t)); };
  const auto plain = [&](std::uint32_t t) {
    if (!sample_centre(t, theirs(t), samples)) samples.fail();
    return !samples.settled();
  };
  const auto patch = [&](const PlaneCells& cells) {
    samples.note_cells(side_, cells, [](PatchTriangle) { return kNoIndex; });
    return !samples.settled();
  };
  visit_uniform_parts({&side_.self, &side_.other}, wanted, plain, patch, side_.budget);
}

}  // namespace satcheck
