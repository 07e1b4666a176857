// The tree holds every triangle once, inside the boxes above it.
#include "bvh.hpp"

#include "check.hpp"
#include "shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

bool holds(const Aabb& outer, const Aabb& inner) {
  return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
         outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
}

void check_tree(const Mesh& mesh) {
  const Bvh bvh = build_bvh(mesh);
  std::vector<int> seen(mesh.triangles.size(), 0);
  for (const BvhNode& node : bvh.nodes) {
    if (node.is_leaf()) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        ++seen[bvh.order[i]];
        CHECK(holds(node.box, triangle_box(mesh, bvh.order[i])));
      }
    } else {
      CHECK(holds(node.box, bvh.nodes[node.first].box) && holds(node.box, bvh.nodes[node.first + 1].box));
    }
  }
  for (const int count : seen) CHECK(count == 1);
  CHECK(bvh.order == build_bvh(mesh).order);
}

}  // namespace

int main() {
  CHECK(build_bvh({}).nodes.empty());
  check_tree(box({0, 0, 0}, {1, 1, 1}));
  check_tree(uv_sphere(30));
  Mesh same_place;
  for (int i = 0; i < 100; ++i) append(same_place, box({0, 0, 0}, {1, 1, 1}));
  check_tree(same_place);
  check_tree(Mesh{{{-1e308, 0, 0}, {1e308, 0, 0}, {0, 1e308, 0}},
                  {{0, 1, 2}, {0, 1, 2}, {0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0, 1, 1}}});
  return exit_status();
}
