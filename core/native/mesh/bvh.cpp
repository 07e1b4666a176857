// Method: Christian Lauterbach and others, "Fast BVH Construction on GPUs" (2009): triangles are sorted
// along a Morton curve through their centres, and a range is cut where the highest bit of its codes
// changes. Splits by surface area take three times as long and save a seventh of the box tests. Where we deviate: long
// ranges are separate tasks. They are split and joined in an order that depends only on the coordinates and the order
// of triangles, so the number of threads has no effect.
#include "mesh/bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "base/key_sort.hpp"
#include "base/large_pages.hpp"
#include "base/parallel.hpp"

namespace satcheck {
namespace {

constexpr std::uint32_t kLeafSize = 6;     // a leaf has at most this many triangles
constexpr std::uint32_t kTaskSize = 8192;  // triangles that one thread handles at a time
constexpr int kAxisBits = 21;              // of a Morton code: three of them fit into 64 bits

struct Range {
  std::uint32_t first, count;
};

// 21 bits, with two zeros between any two.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x001F00000000FFFFu;
  x = (x | x << 16) & 0x001F0000FF0000FFu;
  x = (x | x << 8) & 0x100F00F00F00F00Fu;
  x = (x | x << 4) & 0x10C30C30C30C30C3u;
  return (x | x << 2) & 0x1249249249249249u;
}

// The curve through the cells of a cube around a box.
class MortonCurve {
 public:
  explicit MortonCurve(const Aabb& box) : low_(box.min) {
    const double scale = (kLastCell + 1) / max_abs(box.size());
    scale_ = std::isfinite(scale) ? scale : 0;
  }
  std::uint64_t code(Vec3 p) const {
    const Vec3 q = (p - low_) * scale_;
    return spread_bits(cell(q.x)) << 2 | spread_bits(cell(q.y)) << 1 | spread_bits(cell(q.z));
  }

 private:
  static constexpr double kLastCell = (1 << kAxisBits) - 1;

  static std::uint64_t cell(double q) { return static_cast<std::uint64_t>(q < kLastCell ? q : kLastCell); }

  Vec3 low_;
  double scale_;
};

// How many items of a sorted range go to the left child: at least 1, and not all.
std::uint32_t left_count(const std::vector<Keyed>& items, Range range) {
  const auto begin = items.begin() + range.first, end = begin + range.count;
  const std::uint64_t differing = begin->key ^ (end - 1)->key;
  if (differing == 0) return range.count / 2;
  const std::uint64_t highest = std::bit_floor(differing);
  const auto middle =
      std::partition_point(begin, end, [&](const Keyed& item) { return (item.key & highest) == 0; });
  return static_cast<std::uint32_t>(middle - begin);
}

struct Subtree {
  std::vector<BvhNode> nodes;
  std::vector<std::uint32_t> leaves;  // their numbers
};

// Cuts a range of the sorted items down to leaves of at most `leaf_size`. The boxes are still empty.
Subtree grow(const std::vector<Keyed>& items, Range whole, std::uint32_t leaf_size) {
  Subtree tree;
  tree.nodes.emplace_back();
  std::vector<std::pair<std::uint32_t, Range>> pending{{0, whole}};
  while (!pending.empty()) {
    const auto [number, range] = pending.back();
    pending.pop_back();
    if (range.count <= leaf_size) {
      tree.nodes[number].first = range.first;
      tree.nodes[number].count = range.count;
      tree.leaves.push_back(number);
      continue;
    }
    const std::uint32_t left = left_count(items, range);
    const auto child = static_cast<std::uint32_t>(tree.nodes.size());
    tree.nodes[number].first = child;
    tree.nodes.resize(tree.nodes.size() + 2);
    pending.push_back({child + 1, {range.first + left, range.count - left}});
    pending.push_back({child, {range.first, left}});
  }
  return tree;
}

// Gives the first nodes their boxes. Children come after their parents.
void fit_boxes(std::vector<BvhNode>& nodes, std::size_t count, const std::vector<Aabb>& boxes) {
  while (count-- > 0) {
    BvhNode& node = nodes[count];
    if (node.is_leaf()) {
      node.box = boxes[node.first];
      for (std::uint32_t i = node.first + 1; i < node.first + node.count; ++i) node.box.include(boxes[i]);
    } else {
      node.box = nodes[node.first].box;
      node.box.include(nodes[node.first + 1].box);
    }
  }
}

// Replaces leaves of the trunk by branches. The nodes of the branches follow those of the trunk.
std::vector<BvhNode> graft(const Subtree& trunk, std::vector<Subtree>& branches) {
  std::vector<BvhNode> nodes = trunk.nodes;
  std::size_t total = nodes.size();
  for (const Subtree& branch : branches) total += branch.nodes.size();
  nodes.reserve(total);
  for (std::size_t i = 0; i < branches.size(); ++i) {
    std::vector<BvhNode>& branch = branches[i].nodes;
    const auto shift = static_cast<std::uint32_t>(nodes.size()) - 1;  // the root is not among the followers
    for (BvhNode& node : branch) node.first += node.is_leaf() ? 0 : shift;
    nodes[trunk.leaves[i]] = branch[0];
    nodes.insert(nodes.end(), branch.begin() + 1, branch.end());
  }
  return nodes;
}

// The tree over the items, which are not yet sorted and whose boxes are box_of(number).
template <class BoxOf>
Bvh build(std::vector<Keyed> items, BoxOf box_of, unsigned threads) {
  const auto count = static_cast<std::uint32_t>(items.size());
  sort_by_key(items);
  Bvh bvh;
  bvh.order.resize(count);
  bvh.boxes = with_room<Aabb>(count);
  bvh.boxes.resize(count);
  const Subtree trunk = grow(items, {0, count}, kTaskSize);
  std::vector<Subtree> branches(trunk.leaves.size());
  parallel_for(branches.size(), threads, [&](std::size_t i) {
    const BvhNode& leaf = trunk.nodes[trunk.leaves[i]];
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.count; ++k) {
      bvh.order[k] = items[k].number;
      bvh.boxes[k] = box_of(items[k].number);
    }
    branches[i] = grow(items, {leaf.first, leaf.count}, kLeafSize);
    fit_boxes(branches[i].nodes, branches[i].nodes.size(), bvh.boxes);
  });
  bvh.nodes = graft(trunk, branches);
  fit_boxes(bvh.nodes, trunk.nodes.size(), bvh.boxes);
  return bvh;
}


// A bit for each side of a region: lower and upper along x, along y, along z.
using Sides = std::uint8_t;
constexpr std::size_t kSides = 6;

// The sides that each point lies beyond. A triangle is beyond a side if all its corners are.
std::vector<Sides> sides_beyond(const Aabb& region, const std::vector<Vec3>& points) {
  std::vector<Sides> sides;
  sides.reserve(points.size());
  for (const Vec3& p : points) {
    unsigned bits = 0;
    for (int axis = 0; axis < 3; ++axis) {
      bits |= static_cast<unsigned>(p[axis] < region.min[axis]) << 2 * axis;
      bits |= static_cast<unsigned>(p[axis] > region.max[axis]) << (2 * axis + 1);
    }
    sides.push_back(static_cast<Sides>(bits));
  }
  return sides;
}

Vec3 clamped(Vec3 p, const Aabb& box) {
  const auto within = [](double c, double low, double high) { return c < low ? low : c > high ? high : c; };
  return {within(p.x, box.min.x, box.max.x), within(p.y, box.min.y, box.max.y), within(p.z, box.min.z, box.max.z)};
}

// One tree from a tree, which may be empty, and additional leaves.
std::vector<BvhNode> beside(const std::vector<BvhNode>& tree, const std::vector<BvhNode>& leaves) {
  if (leaves.empty()) return tree;
  std::vector<BvhNode> parts;  // roots
  if (!tree.empty()) parts.push_back(tree[0]);
  parts.insert(parts.end(), leaves.begin(), leaves.end());
  std::vector<BvhNode> nodes(1);
  nodes.reserve(tree.size() + 2 * parts.size());
  std::uint32_t last = 0;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    const auto left = static_cast<std::uint32_t>(nodes.size());
    nodes[last].first = left;
    nodes.push_back(parts[i]);
    nodes.emplace_back();
    last = left + 1;
  }
  nodes[last] = parts.back();
  const std::size_t count = nodes.size();
  if (!tree.empty()) {
    const auto shift = static_cast<std::uint32_t>(count - 1);  // the root is in its place already
    nodes.insert(nodes.end(), tree.begin() + 1, tree.end());
    for (std::size_t i = count; i < nodes.size(); ++i) nodes[i].first += nodes[i].is_leaf() ? 0 : shift;
    nodes[1].first += nodes[1].is_leaf() ? 0 : shift;
  }
  for (std::size_t i = count; i-- > 0;) {
    if (nodes[i].is_leaf() || nodes[i].first >= count) continue;
    nodes[i].box = nodes[nodes[i].first].box;
    nodes[i].box.include(nodes[nodes[i].first + 1].box);
  }
  return nodes;
}

// 0: compact. 1, 2, 3: long along x, y or z. 4, 5, 6: flat across x, y or z.
std::uint64_t form_of(const Aabb& box) {
  constexpr double kElongated = 4;  // times as long as the next axis
  const Vec3 size = box.size();
  int axis[3] = {0, 1, 2};
  std::sort(axis, axis + 3, [&](int i, int j) { return size[i] != size[j] ? size[i] < size[j] : i < j; });
  if (size[axis[1]] * kElongated < size[axis[2]]) return 1 + static_cast<std::uint64_t>(axis[2]);
  if (size[axis[0]] * kElongated < size[axis[1]]) return 4 + static_cast<std::uint64_t>(axis[0]);
  return 0;
}

}  // namespace

Bvh build_bvh(const Mesh& mesh, unsigned threads) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  if (count == 0) return {};
  const Aabb bounds = bounds_of(mesh.vertices);
  const MortonCurve curve(bounds);
  const auto box_of = [&](std::uint32_t t) { return triangle_box(mesh, t); };
  std::vector<Keyed> items = with_room<Keyed>(count);
  items.resize(count);
  const auto place_on_curve = [&](std::size_t i) {
    const auto t = static_cast<std::uint32_t>(i);
    items[t] = {curve.code(box_of(t).centre()), t};
  };
  parallel_for(count, threads, place_on_curve, kTaskSize);
  return build(std::move(items), box_of, threads);
}

Bvh build_bvh_near(const Mesh& mesh, const Aabb& region, unsigned threads) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  if (count == 0) return {};
  const auto box_of = [&](std::uint32_t t) { return triangle_box(mesh, t); };
  const MortonCurve curve(region);
  const std::vector<Sides> sides = sides_beyond(region, mesh.vertices);
  std::vector<Sides> member(mesh.vertices.size());  // the leaves that a vertex belongs to
  std::vector<Keyed> items;
  std::array<std::vector<std::uint32_t>, kSides> beyond;
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const unsigned common = sides[a] & sides[b] & sides[c];
    if (common == 0) {
      items.push_back({curve.code(clamped(box_of(t).centre(), region)), t});
      continue;
    }
    const int side = std::countr_zero(common);
    beyond[static_cast<std::size_t>(side)].push_back(t);
    for (const std::uint32_t v : {a, b, c}) member[v] |= static_cast<Sides>(1 << side);
  }
  std::array<Aabb, kSides> around;
  for (std::size_t v = 0; v < member.size(); ++v) {
    for (unsigned left = member[v]; left != 0; left &= left - 1) {
      around[static_cast<std::size_t>(std::countr_zero(left))].include(mesh.vertices[v]);
    }
  }
  Bvh bvh = items.empty() ? Bvh{} : build(std::move(items), box_of, threads);
  bvh.order.reserve(count);
  std::vector<BvhNode> leaves;
  for (const std::size_t side : {0u, 2u, 4u, 1u, 3u, 5u}) {  // the lower ones first
    const std::vector<std::uint32_t>& triangles = beyond[side];
    if (triangles.empty()) continue;
    const auto first = static_cast<std::uint32_t>(bvh.order.size());
    leaves.push_back({around[side], first, static_cast<std::uint32_t>(triangles.size())});
    bvh.order.insert(bvh.order.end(), triangles.begin(), triangles.end());
  }
  bvh.nodes = beside(bvh.nodes, leaves);
  return bvh;
}

std::vector<std::uint32_t> order_along_curve(const std::vector<Aabb>& boxes) {
  Aabb bounds;
  for (const Aabb& box : boxes) bounds.include(box);
  const MortonCurve curve(bounds);
  std::vector<Keyed> items;
  for (const Aabb& box : boxes) items.push_back({curve.code(box.centre()), static_cast<std::uint32_t>(items.size())});
  sort_by_key(items);
  std::vector<std::uint32_t> order;
  for (const Keyed& item : items) order.push_back(item.number);
  return order;
}

void refit(Bvh& bvh, const Mesh& mesh) {
  bvh.boxes.resize(bvh.order.size());
  for (std::size_t k = 0; k < bvh.order.size(); ++k) bvh.boxes[k] = triangle_box(mesh, bvh.order[k]);
  fit_boxes(bvh.nodes, bvh.nodes.size(), bvh.boxes);
}

Bvh build_bvh_by_form(const std::vector<Aabb>& boxes, unsigned threads) {
  if (boxes.empty()) return {};
  Aabb bounds;
  for (const Aabb& box : boxes) bounds.include(box);
  const MortonCurve curve(bounds);
  std::vector<Keyed> items(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    // A Morton code without its last bit for each axis leaves room for the form above it.
    items[i] = {form_of(boxes[i]) << 3 * (kAxisBits - 1) | curve.code(boxes[i].centre()) >> 3, i};
  }
  return build(std::move(items), [&](std::uint32_t i) { return boxes[i]; }, threads);
}

}  // namespace satcheck
