#include "mesh_pair/common_triangles.hpp"

#include <algorithm>
#include <utility>

#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// Measured steps of a triangle that is looked up.
constexpr std::uint64_t kTriangleWork = 300;

// The vertices within a box in the order of their coordinates, without points that have several vertices.
std::vector<std::uint32_t> single_vertices(const Mesh& mesh, const Aabb& box) {
  std::vector<std::uint32_t> sorted, single;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (meet(box, {mesh.vertices[v], mesh.vertices[v]})) sorted.push_back(v);
  }
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t u, std::uint32_t v) {
    return coordinates_less(mesh.vertices[u], mesh.vertices[v]);
  });
  for (std::size_t i = 0, next = 0; i < sorted.size(); i = next) {
    for (next = i + 1; next < sorted.size() && mesh.vertices[sorted[next]] == mesh.vertices[sorted[i]];) ++next;
    if (next == i + 1) single.push_back(sorted[i]);
  }
  return single;
}

struct NamedTriangle {
  Triangle name;  // its corners as vertices of A, sorted
  std::uint32_t number;
};

// The triangles whose corners all have a name, in the order of their names, then numbers.
std::vector<NamedTriangle> named_triangles(const Mesh& mesh, const std::vector<std::uint32_t>& names, std::uint32_t none) {
  std::vector<NamedTriangle> named;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle name;
    for (int i = 0; i < 3; ++i) name[i] = names[mesh.triangles[t][i]];
    std::sort(name.begin(), name.end());
    if (name[2] != none) named.push_back({name, t});
  }
  std::sort(named.begin(), named.end(), [](const NamedTriangle& t, const NamedTriangle& u) {
    return t.name != u.name ? t.name < u.name : t.number < u.number;
  });
  return named;
}

bool is_collinear(const Corners& c, Budget* budget) { return collinear(c[0], c[1], c[2], budget); }

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
  spend(budget_, kTriangleWork * (a.mesh.triangles.size() + b.mesh.triangles.size()));
  std::vector<std::uint32_t> names_a(a.mesh.vertices.size(), kNone), names_b(b.mesh.vertices.size(), kNone);
  {
    const auto of_a = single_vertices(a.mesh, b.bvh.nodes[0].box), of_b = single_vertices(b.mesh, a.bvh.nodes[0].box);
    auto v = of_b.begin();
    for (const std::uint32_t u : of_a) {
      while (v != of_b.end() && coordinates_less(b.mesh.vertices[*v], a.mesh.vertices[u])) ++v;
      if (v != of_b.end() && b.mesh.vertices[*v] == a.mesh.vertices[u]) names_a[u] = names_b[*v] = u;
    }
  }
  of_a_.assign(a.mesh.triangles.size(), kNone);
  of_b_.assign(b.mesh.triangles.size(), kNone);
  const auto named_a = named_triangles(a.mesh, names_a, kNone), named_b = named_triangles(b.mesh, names_b, kNone);
  auto u = named_b.begin();
  for (auto t = named_a.begin(); t != named_a.end();) {
    const Triangle& name = t->name;
    const auto has_name = [&](const NamedTriangle& other) { return other.name == name; };
    u = std::find_if(u, named_b.end(), [&](const NamedTriangle& other) { return !(other.name < name); });
    const auto t_end = std::find_if_not(t, named_a.end(), has_name), u_end = std::find_if_not(u, named_b.end(), has_name);
    if (t_end - t == 1 && u_end - u == 1 && !is_collinear(corners(a.mesh, t->number), budget_)) {
      of_a_[t->number] = u->number;
      of_b_[u->number] = t->number;
      ++count_;
    }
    t = t_end, u = u_end;
  }
  across_.assign(3 * of_a_.size(), kNone);
  irregular_.assign(of_a_.size(), false);
}

bool CommonTriangles::note(std::uint32_t ta, std::uint32_t tb) {
  const std::uint32_t copy_b = of_a_[ta], copy_a = of_b_[tb];
  if (copy_b == kNone && copy_a == kNone) return false;
  if (copy_b == tb) return true;
  const bool in_b = copy_b != kNone;  // compares the copy of ta with tb; otherwise ta with the copy of tb
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
  if ((!in_b || copy_a == kNone) && is_collinear(other, budget_)) return false;
  if (compared_->has_more_in_common_with(in_b ? tb : copy_a)) {
    irregular_[common] = true;
    return false;
  }
  note_neighbour(common, other, in_b && copy_a != kNone ? copy_a : kSeveral);
  return in_b && copy_a != kNone;
}

// number: the other triangle, if it is common.
void CommonTriangles::note_neighbour(std::uint32_t t, const Corners& other, std::uint32_t number) {
  const int edge = shared_edge(corners(a_.mesh, t), other);
  if (edge < 0) return;
  std::uint32_t& across = across_[3 * t + static_cast<std::uint32_t>(edge)];
  across = across == kNone ? number : kSeveral;
}

std::vector<std::vector<ContactPair>> CommonTriangles::regions() const {
  std::vector<std::vector<ContactPair>> regions;
  std::vector<bool> done = irregular_;
  for (std::uint32_t first = 0; first < of_a_.size(); ++first) {
    if (of_a_[first] == kNone || done[first]) continue;
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
    if (of_a_[t] != kNone && irregular_[t]) pairs.push_back({t, of_a_[t]});
  }
  return pairs;
}

}  // namespace satcheck
