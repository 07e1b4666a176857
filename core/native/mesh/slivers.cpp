#include "mesh/slivers.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "base/edge_table.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// Neighbouring slivers may need several rounds. A few are enough in practice.
constexpr std::size_t kTurns = 16;

class Slivers {
 public:
  explicit Slivers(const Mesh& mesh) {
    result_.mesh = mesh;
    result_.source.resize(mesh.triangles.size());
    std::iota(result_.source.begin(), result_.source.end(), 0u);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (is_sliver(t)) waiting_.push_back(t);
    }
    result_.changed = !waiting_.empty();
  }

  Sliverless remove() {
    if (waiting_.empty()) return std::move(result_);
    for (std::uint32_t t = 0; t < result_.mesh.triangles.size(); ++t) enter(t);
    for (std::size_t turns = kTurns * waiting_.size(); turns > 0 && !waiting_.empty(); --turns) {
      const std::uint32_t t = waiting_.back();
      waiting_.pop_back();
      if (is_sliver(t)) flip(t);
    }
    return std::move(result_);
  }

 private:
  using HalfEdge = std::pair<std::uint32_t, std::uint32_t>;

  bool is_sliver(std::uint32_t t) const {
    const Triangle& v = result_.mesh.triangles[t];
    const std::vector<Vec3>& at = result_.mesh.vertices;
    return !repeats_a_corner(v) && collinear(at[v[0]], at[v[1]], at[v[2]]);
  }

  // Turned so that the second corner is between the others.
  Triangle turned(Triangle v) const {
    const std::vector<Vec3>& at = result_.mesh.vertices;
    const auto between = [&](std::uint32_t p, std::uint32_t m, std::uint32_t q) {
      return coordinates_less(at[p], at[m]) == coordinates_less(at[m], at[q]);
    };
    for (int i = 0; i < 2 && !between(v[0], v[1], v[2]); ++i) std::rotate(v.begin(), v.begin() + 1, v.end());
    return v;
  }

  void enter(std::uint32_t t) {
    const Triangle& v = result_.mesh.triangles[t];
    if (repeats_a_corner(v)) return;
    for (int i = 0; i < 3; ++i) users_[{v[i], v[(i + 1) % 3]}].push_back(t);
  }

  void leave(std::uint32_t t) {
    const Triangle& v = result_.mesh.triangles[t];
    for (int i = 0; i < 3; ++i) std::erase(users_[{v[i], v[(i + 1) % 3]}], t);
  }

  std::size_t use(std::uint32_t u, std::uint32_t v) { return users_[{u, v}].size(); }

  // p m q with the triangle p q r across its long edge become p m r and m q r.
  void flip(std::uint32_t t) {
    const auto [p, m, q] = turned(result_.mesh.triangles[t]);
    if (use(p, q) != 1 || use(q, p) != 1) return;
    const std::uint32_t across = users_[{p, q}][0];
    const Triangle& n = result_.mesh.triangles[across];
    const std::uint32_t r = n[0] != p && n[0] != q ? n[0] : n[1] != p && n[1] != q ? n[1] : n[2];
    leave(t);
    leave(across);
    result_.mesh.triangles[t] = {p, m, r};
    result_.mesh.triangles[across] = {m, q, r};
    result_.source[t] = result_.source[across];
    for (const std::uint32_t changed : {t, across}) {
      enter(changed);
      if (is_sliver(changed)) waiting_.push_back(changed);
    }
  }

  Sliverless result_;
  std::vector<std::uint32_t> waiting_;
  std::map<HalfEdge, std::vector<std::uint32_t>> users_;
};

}  // namespace

Sliverless without_slivers(const Mesh& welded) { return Slivers(welded).remove(); }

}  // namespace satcheck
