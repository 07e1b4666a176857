// The tree holds every triangle once, inside the boxes above it, and is the same at any number of threads.
#include "bvh.hpp"

#include <algorithm>

#include "check.hpp"
#include "shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

bool holds(const Aabb& outer, const Aabb& inner) {
  return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
         outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
}

bool same(const Aabb& a, const Aabb& b) { return a.min == b.min && a.max == b.max; }

void check_same(const Bvh& a, const Bvh& b) {
  CHECK(a.order == b.order && a.nodes.size() == b.nodes.size());
  for (std::size_t i = 0; i < std::min(a.nodes.size(), b.nodes.size()); ++i) {
    const BvhNode &m = a.nodes[i], &n = b.nodes[i];
    CHECK(same(m.box, n.box) && m.first == n.first && m.count == n.count);
  }
}

void check_tree(const Mesh& mesh) {
  const Bvh bvh = build_bvh(mesh);
  std::vector<int> seen(mesh.triangles.size(), 0);
  for (const BvhNode& node : bvh.nodes) {
    if (node.is_leaf()) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        ++seen[bvh.order[i]];
        CHECK(holds(node.box, triangle_box(mesh, bvh.order[i])));
        CHECK(same(bvh.boxes[i], triangle_box(mesh, bvh.order[i])));
      }
    } else {
      CHECK(holds(node.box, bvh.nodes[node.first].box) && holds(node.box, bvh.nodes[node.first + 1].box));
    }
  }
  for (const int count : seen) CHECK(count == 1);
  check_same(bvh, build_bvh(mesh, 1));
}

}  // namespace

int main() {
  CHECK(build_bvh({}).nodes.empty());
  check_tree(box({0, 0, 0}, {1, 1, 1}));
  check_tree(uv_sphere(30));
  // More triangles than one thread takes alone.
  const Mesh large = uv_sphere(200);
  check_same(build_bvh(large, 1), build_bvh(large, 2));
  check_same(build_bvh(large, 1), build_bvh(large, 7));
  Mesh same_place;
  for (int i = 0; i < 100; ++i) append(same_place, box({0, 0, 0}, {1, 1, 1}));
  check_tree(same_place);
  check_tree(Mesh{{{-1e308, 0, 0}, {1e308, 0, 0}, {0, 1e308, 0}},
                  {{0, 1, 2}, {0, 1, 2}, {0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0, 1, 1}}});
  return exit_status();
}
