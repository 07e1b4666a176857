// The tree holds every triangle once, inside the boxes above it, and is the same at any number of threads.
#include "mesh/bvh.hpp"

#include <algorithm>

#include "tests/check.hpp"
#include "tests/shapes.hpp"

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

void check_holds(const Bvh& bvh, const std::vector<Aabb>& boxes) {
  std::vector<int> seen(boxes.size(), 0);
  for (const BvhNode& node : bvh.nodes) {
    if (node.is_leaf()) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        ++seen[bvh.order[i]];
        CHECK(holds(node.box, boxes[bvh.order[i]]));
        CHECK(i >= bvh.boxes.size() || same(bvh.boxes[i], boxes[bvh.order[i]]));
      }
    } else {
      CHECK(holds(node.box, bvh.nodes[node.first].box) && holds(node.box, bvh.nodes[node.first + 1].box));
    }
  }
  for (const int count : seen) CHECK(count == 1);
}

std::vector<Aabb> triangle_boxes(const Mesh& mesh) {
  std::vector<Aabb> boxes;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) boxes.push_back(triangle_box(mesh, t));
  return boxes;
}

void check_tree(const Mesh& mesh) {
  const Bvh bvh = build_bvh(mesh);
  check_holds(bvh, triangle_boxes(mesh));
  check_same(bvh, build_bvh(mesh, 1));
  check_holds(build_bvh_by_form(triangle_boxes(mesh)), triangle_boxes(mesh));
}

// Few leaves are large, and they are off the region.
void check_near(const Mesh& mesh, const Aabb& region) {
  const Bvh bvh = build_bvh_near(mesh, region);
  check_holds(bvh, triangle_boxes(mesh));
  check_same(bvh, build_bvh_near(mesh, region, 1));
  CHECK(same(bvh.nodes[0].box, build_bvh(mesh).nodes[0].box));
  std::size_t large = 0;
  for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    CHECK(node.is_leaf() || node.first > i);
    CHECK(node.count > 6 || !node.is_leaf() || !meet(node.box, region) || node.first + node.count <= bvh.boxes.size());
    if (node.count <= 6) continue;
    ++large;
    CHECK(!meet(node.box, region));
  }
  CHECK(large <= 6);
}

// The same tree over vertices that an affine map has moved: the boxes are those of the triangles there.
void check_refit(const Mesh& mesh) {
  Bvh bvh = build_bvh(mesh);
  const Bvh before = bvh;
  Mesh moved = mesh;
  for (Vec3& p : moved.vertices) p = {3 * p.y - 1, 0.5 * p.x + p.z, -p.z};
  refit(bvh, moved);
  check_holds(bvh, triangle_boxes(moved));
  CHECK(bvh.order == before.order && bvh.nodes.size() == before.nodes.size());
  refit(bvh, mesh);
  check_same(bvh, before);
}

// Beams along x and along y share no node but the root.
void check_forms() {
  std::vector<Aabb> boxes;
  for (int k = 0; k < 100; ++k) {
    boxes.push_back({{0, 1.0 * k, 0}, {100, k + 0.5, 1}});
    boxes.push_back({{1.0 * k, 0, 0}, {k + 0.5, 100, 1}});
  }
  const Bvh bvh = build_bvh_by_form(boxes);
  check_holds(bvh, boxes);
  for (const BvhNode& node : bvh.nodes) {
    for (std::uint32_t i = node.first; node.is_leaf() && i < node.first + node.count; ++i) {
      CHECK(bvh.order[i] % 2 == bvh.order[node.first] % 2);
    }
  }
}

}  // namespace

UNIT(bvh) {
  CHECK(build_bvh(Mesh{}).nodes.empty() && build_bvh_by_form({}).nodes.empty());
  check_forms();
  check_refit(uv_sphere(30));
  check_refit(box({0, 0, 0}, {1, 1, 1}));
  check_tree(box({0, 0, 0}, {1, 1, 1}));
  check_tree(uv_sphere(30));
  for (const Aabb& region : {Aabb{{-2, -2, -2}, {2, 2, 2}}, Aabb{{0.9, -1, -1}, {3, 1, 1}}, Aabb{{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}},
                             Aabb{{0.3, 0.3, 0.3}, {0.8, 0.8, 0.8}}, Aabb{{5, 5, 5}, {6, 6, 6}}}) {
    check_near(uv_sphere(30), region);
    check_near(box({0, 0, 0}, {1, 1, 1}), region);
  }
  CHECK(build_bvh_near(Mesh{}, {{0, 0, 0}, {1, 1, 1}}).nodes.empty());
  // More triangles than one thread takes alone.
  const Mesh large = uv_sphere(200);
  check_same(build_bvh(large, 1), build_bvh(large, 2));
  check_same(build_bvh(large, 1), build_bvh(large, 7));
  Mesh same_place;
  for (int i = 0; i < 100; ++i) append(same_place, box({0, 0, 0}, {1, 1, 1}));
  check_tree(same_place);
  check_tree(Mesh{{{-1e308, 0, 0}, {1e308, 0, 0}, {0, 1e308, 0}},
                  {{0, 1, 2}, {0, 1, 2}, {0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0, 1, 1}}});
}
