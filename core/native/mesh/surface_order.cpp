#include "mesh/surface_order.hpp"

#include <algorithm>

namespace satcheck {
namespace {

// < 0: the first, > 0: the second, 0: alike.
int order(Vec3 a, Vec3 b) { return a == b ? 0 : coordinates_less(a, b) ? -1 : 1; }

int order(const Mesh& a, const Mesh& b) {
  if (a.vertices.size() != b.vertices.size()) return a.vertices.size() < b.vertices.size() ? -1 : 1;
  const auto differ = std::mismatch(a.vertices.begin(), a.vertices.end(), b.vertices.begin());
  if (differ.first != a.vertices.end()) return order(*differ.first, *differ.second);
  return a.triangles == b.triangles ? 0 : a.triangles < b.triangles ? -1 : 1;
}

}  // namespace

bool comes_before(const Surface& a, const Surface& b) {
  if (&a.mesh == &b.mesh || a.bvh.nodes.empty() || b.bvh.nodes.empty()) return true;
  const Aabb &box_a = a.bvh.nodes[0].box, &box_b = b.bvh.nodes[0].box;
  if (const int by_min = order(box_a.min, box_b.min)) return by_min < 0;
  if (const int by_max = order(box_a.max, box_b.max)) return by_max < 0;
  return order(a.mesh, b.mesh) <= 0;
}

}  // namespace satcheck
