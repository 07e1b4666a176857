#include "mesh/surface.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "base/edge_table.hpp"
#include "base/parallel.hpp"
#include "base/patches.hpp"
#include "exact/triangle_distance.hpp"
#include "mesh/boundary.hpp"
#include "mesh/topology.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

constexpr std::size_t kFewTriangles = 8192;  // too few for a second thread

std::vector<std::uint32_t> find_parts(const Mesh& welded) {
  DisjointSets sets(welded.vertices.size());
  for (const Triangle& t : welded.triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }
  std::vector<bool> known(welded.vertices.size(), false);
  std::vector<std::uint32_t> parts;
  for (std::uint32_t t = 0; t < welded.triangles.size(); ++t) {
    const std::uint32_t part = sets.find(welded.triangles[t][0]);
    if (!known[part]) parts.push_back(t);
    known[part] = true;
  }
  return parts;
}

// Whether both have the same triangles, perhaps turned over as in transform().
bool has_triangles_of(const Mesh& a, const Mesh& b) {
  if (a.vertices.size() != b.vertices.size()) return false;
  if (a.triangles.size() != b.triangles.size()) return false;
  if (a.triangles.empty()) return true;
  if (std::memcmp(a.triangles.data(), b.triangles.data(), a.triangles.size() * sizeof(Triangle)) == 0) return true;
  const auto mirrored = [](const Triangle& s, const Triangle& t) {
    return s[0] == t[0] && s[1] == t[2] && s[2] == t[1];
  };
  return std::equal(a.triangles.begin(), a.triangles.end(), b.triangles.begin(), b.triangles.end(), mirrored);
}

// < 0: the first, > 0: the second, 0: alike.
int order(Vec3 a, Vec3 b) { return a == b ? 0 : coordinates_less(a, b) ? -1 : 1; }

int order(const Mesh& a, const Mesh& b) {
  if (a.vertices.size() != b.vertices.size()) return a.vertices.size() < b.vertices.size() ? -1 : 1;
  const auto differ = std::mismatch(a.vertices.begin(), a.vertices.end(), b.vertices.begin());
  if (differ.first != a.vertices.end()) return order(*differ.first, *differ.second);
  return a.triangles == b.triangles ? 0 : a.triangles < b.triangles ? -1 : 1;
}

// Measured steps of a triangle on the way.
constexpr std::uint64_t kPassedWork = 25;

// Calls compare(triangle), which lowers `best`, for the triangles of boxes with a lower bound below it, the nearest first.
template <class Bound, class Compare>
void visit_nearest(const Surface& surface, const double& best, Bound bound, Compare compare, Budget* budget) {
  std::vector<std::pair<double, std::uint32_t>> stack;
  stack.reserve(kUsualDepth);
  stack.push_back({0.0, 0u});
  while (!stack.empty()) {
    const auto [least, index] = stack.back();
    stack.pop_back();
    spend(budget, kNodeWork);
    if (!(least < best)) continue;
    const BvhNode& node = surface.bvh.nodes[index];
    if (!node.is_leaf()) {
      const auto bounded = [&](std::uint32_t child) { return std::pair{bound(surface.bvh.nodes[child].box), child}; };
      auto farther = bounded(node.first), nearer = bounded(node.first + 1);
      if (farther.first < nearer.first) std::swap(farther, nearer);
      stack.push_back(farther);
      stack.push_back(nearer);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (!(bound(box_at(surface.bvh, surface.mesh, i)) < best)) continue;
      spend(budget, kPassedWork);
      compare(surface.bvh.order[i]);
    }
  }
}

}  // namespace

Surface make_surface(const Mesh& mesh, bool solid, OpenParts open) {
  Surface surface(std::make_shared<const Mesh>(weld(mesh)));
  // The tree first, which takes longest.
  const std::function<void()> tasks[] = {[&] { surface.bvh = build_bvh(surface.mesh); },
                                         [&] { surface.solid = EdgeTable(surface.mesh.vertices.size(), surface.mesh.triangles).is_balanced(); },
                                         [&] { surface.parts = find_parts(surface.mesh); }};
  const unsigned threads = surface.mesh.triangles.size() < kFewTriangles ? 1 : 0;
  parallel_for(std::size(tasks), threads, [&](std::size_t i) { tasks[i](); });
  if (solid && !surface.solid) throw std::invalid_argument("not a solid: the surface is not closed and consistently wound");
  surface.open_parts = open;
  if (solid) return surface;
  if (!surface.solid) surface.sheets = open == OpenParts::sheets ? open_parts(surface.mesh) : flat_parts(surface.mesh);
  Mesh with_sheets = surface.mesh;
  double_triangles(with_sheets, surface.sheets);
  surface.facing = facing_of(with_sheets);
  surface.solid = surface.solid && surface.facing.inward.empty() && surface.facing.doubtful.empty();
  return surface;
}

Surface make_plain_surface(std::shared_ptr<const Mesh> inspected, const Aabb* region) {
  Surface surface(std::move(inspected));
  surface.solid = true;
  surface.bvh = region ? build_bvh_near(surface.mesh, *region) : build_bvh(surface.mesh);
  surface.parts = {0};
  return surface;
}

Surface refitted_surface(const Surface& like, Mesh mesh) {
  if (!has_triangles_of(like.mesh, mesh) || !is_welded(mesh)) {
    return make_surface(mesh, like.solid, like.open_parts);
  }
  for (Vec3& p : mesh.vertices) p = p + Vec3{};  // -0.0 + 0.0 == +0.0, as in weld()
  Surface surface(std::make_shared<const Mesh>(std::move(mesh)));
  surface.bvh = {like.bvh.nodes, like.bvh.order, {}};
  refit(surface.bvh, surface.mesh);
  surface.parts = like.parts;
  surface.solid = like.solid;
  surface.open_parts = like.open_parts;
  surface.sheets = like.sheets;
  surface.facing = like.facing;
  if (surface.mesh.triangles == like.mesh.triangles) surface.rims = like.rims;
  surface.refitted = true;
  return surface;
}

std::shared_ptr<const Closing> closing_of(const Surface& open, OpenParts parts, Budget* budget) {
  const std::lock_guard<std::mutex> lock(open.closings->mutex);
  auto& closing = open.closings->made[static_cast<std::size_t>(parts)];
  if (closing) return closing;
  Budget polling = Budget::that_stops(kNoEnd, [&](const SearchState& state) {
    if (budget != nullptr) budget->tell_again(state.work);
  });
  closing = std::make_shared<const Closing>(close_surface(open, parts, &polling));
  return closing;
}

std::shared_ptr<const Surface> walled_surface(const Surface& open, OpenParts parts) {
  const auto closing = closing_of(open, parts);
  const std::lock_guard<std::mutex> lock(open.closings->mutex);
  auto& walled = open.closings->walled[static_cast<std::size_t>(parts)];
  if (walled) return walled;
  Mesh mesh = closing->surface->mesh;
  for (const Surface& hull : closing->hulls) {
    const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), hull.mesh.vertices.begin(), hull.mesh.vertices.end());
    for (const Triangle& t : hull.mesh.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return walled = std::make_shared<const Surface>(make_surface(mesh, true));
}

std::optional<int> winding_number(const Surface& surface, Vec3 point, Budget* budget) {
  return winding_number(surface.mesh, surface.bvh, point, budget);
}

bool comes_before(const Surface& a, const Surface& b) {
  if (&a.mesh == &b.mesh || a.bvh.nodes.empty() || b.bvh.nodes.empty()) return true;
  const Aabb &box_a = a.bvh.nodes[0].box, &box_b = b.bvh.nodes[0].box;
  if (const int by_min = order(box_a.min, box_b.min)) return by_min < 0;
  if (const int by_max = order(box_a.max, box_b.max)) return by_max < 0;
  return order(a.mesh, b.mesh) <= 0;
}

NearestPoint nearest_point(const Surface& surface, Vec3 p, Budget* budget, const NearestPoint* near) {
  if (surface.bvh.nodes.empty()) throw std::invalid_argument("an empty surface has no nearest point");
  const Aabb at{p, p};
  double best = INFINITY;
  NearestPoint result{};
  const auto compare = [&](std::uint32_t t) {
    const Vec3 q = nearest_on_triangle(p, corners(surface.mesh, t));
    const double d = norm_squared(q - p);
    if (d < best) {
      best = d;
      result = {std::sqrt(d), q, t};
    }
  };
  if (near != nullptr) {
    spend(budget, kPassedWork);
    compare(near->triangle);
  }
  visit_nearest(surface, best, [&](const Aabb& box) { return box_distance_squared(at, box); }, compare, budget);
  return result;
}

double line_distance(const Surface& surface, Vec3 u, Vec3 v, double x, double y, Budget* budget) {
  const auto gap = [](const Aabb& box, Vec3 axis, double at) {
    const Vec3 middle = (box.min + box.max) * 0.5, half = (box.max - box.min) * 0.5;
    const double reach = std::fabs(axis.x) * half.x + std::fabs(axis.y) * half.y + std::fabs(axis.z) * half.z;
    return std::fmax(0.0, std::fabs(dot(axis, middle) - at) - reach);
  };
  const auto bound = [&](const Aabb& box) {
    const double across = gap(box, u, x), along = gap(box, v, y);
    return across * across + along * along;
  };
  double best = INFINITY;  // squared
  visit_nearest(surface, best, bound, [&](std::uint32_t t) {
    Corners flat = corners(surface.mesh, t);
    for (Vec3& p : flat) p = {dot(u, p) - x, dot(v, p) - y, 0};
    best = std::fmin(best, norm_squared(nearest_on_triangle({}, flat)));
  }, budget);
  return std::sqrt(best);
}

}  // namespace satcheck
