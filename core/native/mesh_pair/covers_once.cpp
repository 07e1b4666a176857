#include "mesh_pair/covers_once.hpp"

#include <algorithm>
#include <array>

#include "base/key_sort.hpp"
#include "exact/predicates.hpp"
#include "mesh/self_contact.hpp"
#include "mesh_pair/samples.hpp"

namespace satcheck {
namespace {

// Whether a condition holds beside every piece. False if a sample gives no answer.
template <class Holds>
bool holds_beside_all(const Surface& solid, Holds holds) {
  bool all_hold = true;
  const auto note = [&](const std::optional<Beside>& sides) { all_hold = all_hold && sides && holds(*sides); };
  const auto all = [](std::uint32_t) { return true; };
  const auto plain = [&](std::uint32_t t) {
    const Corners c = corners(solid.mesh, t);
    note(beside_inner(solid, lazy_centroid(c), t, nullptr));
    return all_hold;
  };
  const auto patch = [&](const PlaneCells& cells) {
    for (const std::uint32_t cell : cells.cells()) note(cells.beside(cell, 0));
    return all_hold;
  };
  visit_uniform_parts({&solid}, all, plain, patch);
  return all_hold;
}

// The signs of the components of a normal, exact, as a number below 27. That of the opposite normal is 26 less this.
std::uint32_t way_of(const Corners& c) {
  std::uint32_t way = 0;
  for (const int axis : {0, 1, 2}) way = 3 * way + static_cast<std::uint32_t>(orientation_2d(c[0], c[1], c[2], axis) + 1);
  return way;
}
constexpr std::uint32_t kOpposite = 26, kNoWay = 13;

// Of triangles that are no wider than a crack, as those that close one: none.
std::uint32_t way_of_wide(const Corners& c, double crack) {
  const Vec3 u = c[1] - c[0], v = c[2] - c[0];
  const double area = norm(cross(u, v));
  const bool is_narrow = area == 0 || (crack > 0 && area <= crack * std::max({norm(u), norm(v), norm(c[2] - c[1])}));
  return is_narrow ? kNoWay : way_of(c);
}

// Of the triangles in the order of the tree. Those of a batch are fetched at once: the memory is slower than the rest.
std::vector<std::uint8_t> ordered_ways(const Surface& solid, double crack) {
  const std::vector<std::uint32_t>& order = solid.bvh.order;
  std::vector<std::uint8_t> ways(order.size());
  std::array<Corners, 64> batch;
  for (std::size_t first = 0; first < order.size(); first += batch.size()) {
    const std::size_t count = std::min(batch.size(), order.size() - first);
    for (std::size_t k = 0; k < count; ++k) batch[k] = corners(solid.mesh, order[first + k]);
    for (std::size_t k = 0; k < count; ++k) ways[first + k] = static_cast<std::uint8_t>(way_of_wide(batch[k], crack));
  }
  return ways;
}

// The triangles near which others face the opposite way, by the signs of their normals. Most of a smooth surface faces
// the same way as all that is near, so that whole nodes of its tree are left out.
class OppositeWays {
 public:
  OppositeWays(const Surface& solid, double crack) : solid_(solid), ways_(solid.bvh.nodes.size()), opposite_(ways_.size()) {
    const auto& nodes = solid.bvh.nodes;
    const std::vector<std::uint8_t> ways = ordered_ways(solid, crack);
    for (std::size_t n = nodes.size(); n-- > 0;) {  // children come after their parents
      if (!nodes[n].is_leaf()) {
        ways_[n] = ways_[nodes[n].first] | ways_[nodes[n].first + 1];
        opposite_[n] = opposite_[nodes[n].first] | opposite_[nodes[n].first + 1];
      }
      for (std::uint32_t i = nodes[n].first; i < nodes[n].first + nodes[n].count; ++i) {
        if (ways[i] == kNoWay) continue;
        ways_[n] |= 1u << ways[i];
        opposite_[n] |= 1u << (kOpposite - ways[i]);
      }
    }
  }

  // Without copies that face the same way.
  std::vector<Triangle> triangles() const {
    std::vector<Triangle> list;
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
      const BvhNode& node = solid_.bvh.nodes[stack.back()];
      const std::uint32_t opposite = opposite_[stack.back()];
      stack.pop_back();
      if (!is_near(node.box, opposite)) continue;
      if (!node.is_leaf()) stack.insert(stack.end(), {node.first, node.first + 1});
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        Triangle t = solid_.mesh.triangles[solid_.bvh.order[i]];
        std::rotate(t.begin(), std::ranges::min_element(t), t.end());
        list.push_back(t);
      }
    }
    sort_once(list);
    return list;
  }

 private:
  // Whether a leaf that meets the box has one of these ways.
  bool is_near(const Aabb& box, std::uint32_t ways) const {
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
      const std::uint32_t n = stack.back();
      const BvhNode& node = solid_.bvh.nodes[n];
      stack.pop_back();
      if ((ways_[n] & ways) == 0 || !meet(node.box, box)) continue;
      if (node.is_leaf()) return true;
      stack.insert(stack.end(), {node.first, node.first + 1});
    }
    return false;
  }

  const Surface& solid_;
  std::vector<std::uint32_t> ways_, opposite_;  // of the triangles of each node, a bit each
};

// Whether two triangles that may overlap lie in one plane and face away from each other. Winding numbers differ by one
// across a triangle, so that only the other triangles of its plane can make both sides equal.
bool has_opposite_triangles(const Surface& solid, double crack) {
  const Mesh& mesh = solid.mesh;
  if (mesh.triangles.empty()) return false;
  for (const auto& [p, q, r] : OppositeWays(solid, crack).triangles()) {
    const Corners c{mesh.vertices[p], mesh.vertices[q], mesh.vertices[r]};
    const std::uint32_t way = way_of_wide(c, crack);
    if (way == kNoWay) continue;
    const TrianglePlane plane(c[0], c[1], c[2]);
    const bool none = visit_box(solid.bvh, mesh, bounds_of(c), [&](std::uint32_t other) {
      const Corners d = corners(mesh, other);
      const auto in_plane = [&](Vec3 p) { return plane.side(p) == 0; };
      return way_of_wide(d, crack) != kOpposite - way || !std::all_of(d.begin(), d.end(), in_plane);
    });
    if (!none) return true;
  }
  return false;
}

}  // namespace

bool covers_once(const Surface& solid) {
  const auto at_most_once = [](int winding) { return winding == 0 || winding == 1; };
  return holds_beside_all(solid, [&](const Beside& b) { return at_most_once(b.front) && at_most_once(b.back); });
}

bool has_sheets(const Surface& solid, double crack) {
  return has_opposite_triangles(solid, crack) && !holds_beside_all(solid, [](const Beside& b) { return !b.is_sheet(); });
}

}  // namespace satcheck
