#include "mesh/nearest_point.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "exact/triangle_distance.hpp"

namespace satcheck {
namespace {

// Measured steps of a triangle on the way.
constexpr std::uint64_t kTriangleWork = 25;

}  // namespace

NearestPoint nearest_point(const Surface& surface, Vec3 p, Budget* budget) {
  if (surface.bvh.nodes.empty()) throw std::invalid_argument("an empty surface has no nearest point");
  const Aabb at{p, p};
  double best = INFINITY;
  NearestPoint result{};
  std::vector<std::pair<double, std::uint32_t>> stack;
  stack.reserve(kUsualDepth);
  stack.push_back({0.0, 0u});
  while (!stack.empty()) {
    const auto [bound, index] = stack.back();
    stack.pop_back();
    spend(budget, kNodeWork);
    if (!(bound < best)) continue;
    const BvhNode& node = surface.bvh.nodes[index];
    if (!node.is_leaf()) {
      const auto bounded = [&](std::uint32_t child) {
        return std::pair{box_distance_squared(at, surface.bvh.nodes[child].box), child};
      };
      auto farther = bounded(node.first), nearer = bounded(node.first + 1);
      if (farther.first < nearer.first) std::swap(farther, nearer);
      stack.push_back(farther);
      stack.push_back(nearer);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (!(box_distance_squared(at, box_at(surface.bvh, surface.mesh, i)) < best)) continue;
      spend(budget, kTriangleWork);
      const std::uint32_t t = surface.bvh.order[i];
      const Vec3 q = nearest_on_triangle(p, corners(surface.mesh, t));
      const double d = norm_squared(q - p);
      if (d < best) {
        best = d;
        result = {std::sqrt(d), q, t};
      }
    }
  }
  return result;
}

}  // namespace satcheck
