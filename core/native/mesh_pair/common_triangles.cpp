#include "mesh_pair/common_triangles.hpp"

#include <algorithm>
#include <bit>

#include "base/key_sort.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// Measured steps of a triangle that is looked up.
constexpr std::uint64_t kLookupWork = 300;

// A number that triangles with the same corners have in common, whatever their order, and few others.
std::uint64_t key_of(const Corners& c) {
  std::uint64_t sum = 0;
  for (const Vec3& p : c) {
    std::uint64_t key = 0;
    for (const double x : {p.x, p.y, p.z, 1.0}) {
      key = (key ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15;  // + 0.0: one zero
      key ^= key >> 32;
    }
    sum += key;
  }
  return sum;
}

// The triangles within a box that alone have their key, by key.
std::vector<Keyed> keyed_triangles(const Mesh& mesh, const Aabb& box) {
  std::vector<Keyed> keyed;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (meet(box, triangle_box(mesh, t))) keyed.push_back({key_of(corners(mesh, t)), t});
  }
  sort_by_key(keyed);
  std::size_t count = 0;
  for (std::size_t i = 0, next = 0; i < keyed.size(); i = next) {
    for (next = i + 1; next < keyed.size() && keyed[next].key == keyed[i].key;) ++next;
    if (next == i + 1) keyed[count++] = keyed[i];
  }
  keyed.resize(count);
  return keyed;
}

bool same_corners(const Corners& t, const Corners& u) { return std::is_permutation(t.begin(), t.end(), u.begin()); }

// The edge of t that the other triangle shares, or -1.
int shared_edge(const Corners& t, const Corners& other) {
  int apart = -1, count = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::find(other.begin(), other.end(), t[i]) == other.end()) apart = i, ++count;
  }
  return count == 1 ? (apart + 1) % 3 : -1;
}

}  // namespace

CommonTriangles::CommonTriangles(const Surface& a, const Surface& b, Budget* budget) : a_(a), b_(b), budget_(budget) {
  spend(budget_, kLookupWork * (a.mesh.triangles.size() + b.mesh.triangles.size()));
  of_a_.assign(a.mesh.triangles.size(), kNoIndex);
  of_b_.assign(b.mesh.triangles.size(), kNoIndex);
  const auto keyed_a = keyed_triangles(a.mesh, b.bvh.nodes[0].box), keyed_b = keyed_triangles(b.mesh, a.bvh.nodes[0].box);
  auto u = keyed_b.begin();
  for (const Keyed& t : keyed_a) {
    while (u != keyed_b.end() && u->key < t.key) ++u;
    if (u == keyed_b.end() || u->key != t.key) continue;
    const Corners c = corners(a.mesh, t.number);
    if (!same_corners(c, corners(b.mesh, u->number)) || is_collinear(c, budget_)) continue;
    of_a_[t.number] = u->number;
    of_b_[u->number] = t.number;
    ++count_;
  }
  across_.assign(3 * of_a_.size(), kNoIndex);
  irregular_.assign(of_a_.size(), false);
}

bool CommonTriangles::note(std::uint32_t ta, std::uint32_t tb) {
  const std::uint32_t copy_b = of_a_[ta], copy_a = of_b_[tb];
  if (copy_b == kNoIndex && copy_a == kNoIndex) return false;
  if (copy_b == tb) return true;
  const bool in_b = copy_b != kNoIndex;  // compares the copy of ta with tb; otherwise ta with the copy of tb
  if (last_ != ta) {
    if (in_b) {
      compared_.emplace(b_.mesh, copy_b, budget_);
    } else {
      compared_.emplace(a_.mesh, ta, budget_);
    }
    last_ = ta;
  }
  const Corners other = in_b ? corners(b_.mesh, tb) : corners(a_.mesh, ta);
  const std::uint32_t common = in_b ? ta : copy_a;
  if ((!in_b || copy_a == kNoIndex) && is_collinear(other, budget_)) return false;
  if (compared_->has_more_in_common_with(in_b ? tb : copy_a)) {
    irregular_[common] = true;
    return false;
  }
  note_neighbour(common, other, in_b && copy_a != kNoIndex ? copy_a : kSeveral);
  return in_b && copy_a != kNoIndex;
}

// number: the other triangle, if it is common.
void CommonTriangles::note_neighbour(std::uint32_t t, const Corners& other, std::uint32_t number) {
  const int edge = shared_edge(corners(a_.mesh, t), other);
  if (edge < 0) return;
  std::uint32_t& across = across_[3 * t + static_cast<std::uint32_t>(edge)];
  across = across == kNoIndex ? number : kSeveral;
}

std::vector<std::vector<ContactPair>> CommonTriangles::regions() const {
  std::vector<std::vector<ContactPair>> regions;
  std::vector<bool> done = irregular_;
  for (std::uint32_t first = 0; first < of_a_.size(); ++first) {
    if (of_a_[first] == kNoIndex || done[first]) continue;
    std::vector<ContactPair>& region = regions.emplace_back();
    const auto add = [&](std::uint32_t t) {
      if (t >= kSeveral || done[t]) return;
      done[t] = true;
      region.push_back({t, of_a_[t]});
    };
    add(first);
    for (std::size_t k = 0; k < region.size(); ++k) {
      for (std::uint32_t i = 0; i < 3; ++i) add(across_[3 * region[k].a + i]);
    }
    region.shrink_to_fit();
  }
  return regions;
}

std::vector<ContactPair> CommonTriangles::irregular() const {
  std::vector<ContactPair> pairs;
  for (std::uint32_t t = 0; t < of_a_.size(); ++t) {
    if (of_a_[t] != kNoIndex && irregular_[t]) pairs.push_back({t, of_a_[t]});
  }
  return pairs;
}

}  // namespace satcheck
