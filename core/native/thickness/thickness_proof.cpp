#include "thickness/thickness_proof.hpp"

#include <cmath>
#include <map>
#include <tuple>

namespace satcheck {
namespace {

constexpr int kCut = 3, kOutside = 4, kBounded = 6;

// The axis that a normal runs along, in units; -1: none.
int axis_of(Vec3 normal) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 rest = normal;
    rest.at(axis) = 0;
    if (rest == Vec3{} && std::fabs(normal[axis]) == 1) return axis;
  }
  return -1;
}

}  // namespace

void ThicknessProof::swap_bodies() {
  for (DepthBound& bound : bounds) bound.body = 1 - bound.body;
  for (int& cell : cells) {
    if (cell == kOutside || cell == kOutside + 1) cell = 2 * kOutside + 1 - cell;
  }
}

std::uint32_t ThicknessRecord::add_root() {
  nodes_.push_back({kBounded, {}, 0, {}});
  return 0;
}

std::pair<std::uint32_t, std::uint32_t> ThicknessRecord::divide(std::uint32_t node, const HalfSpace& plane) {
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  std::vector<Term> terms = std::move(nodes_[node].terms);
  nodes_[node] = {kCut, plane, first, {}};
  nodes_.push_back({kBounded, {}, 0, terms});
  nodes_.push_back({kBounded, {}, 0, std::move(terms)});
  return {first, first + 1};
}

void ThicknessRecord::set_outside(std::uint32_t node, int body) { nodes_[node] = {kOutside + body, {}, 0, {}}; }

void ThicknessRecord::set_bound(std::uint32_t node, std::vector<Term> terms) { nodes_[node] = {kBounded, {}, 0, std::move(terms)}; }

class ThicknessRecord::Writer {
 public:
  Writer(const TwoBodies& bodies, Vec3 origin, const Aabb& box) : bodies_(bodies), box_(box) {
    proof_.origin = origin;
    proof_.low = box.min;
    proof_.high = box.max;
  }

  ThicknessProof write(const std::vector<Node>& nodes) {
    std::vector<std::uint32_t> pending{0};
    while (!pending.empty()) {
      const Node& node = nodes[pending.back()];
      pending.pop_back();
      if (node.kind == kCut) {
        const bool turned = write_cut(node.plane);
        pending.push_back(node.first + (turned ? 0 : 1));
        pending.push_back(node.first + (turned ? 1 : 0));
        continue;
      }
      proof_.cells.push_back(node.kind);
      if (node.kind == kBounded) write_sum(node.terms);
    }
    return std::move(proof_);
  }

 private:
  // Whether the second side comes first.
  bool write_cut(const HalfSpace& plane) {
    const int axis = axis_of(plane.normal);
    if (axis < 0) {
      proof_.cells.push_back(kCut);
      proof_.cuts.push_back(plane);
      return false;
    }
    proof_.cells.push_back(axis);
    proof_.at.push_back(plane.height * plane.normal[axis]);
    return plane.normal[axis] < 0;
  }

  void write_sum(const std::vector<Term>& terms) {
    auto& sum = proof_.sums.emplace_back();
    for (const Term& term : terms) sum.emplace_back(number(term), term.weight);
    if (terms.empty()) write_box(sum);
  }

  // Across its shortest side, the bodies end where the box does.
  void write_box(std::vector<std::pair<std::uint32_t, double>>& sum) {
    int shortest = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (box_.max[axis] - box_.min[axis] < box_.max[shortest] - box_.min[shortest]) shortest = axis;
    }
    for (const double sign : {1.0, -1.0}) {
      HalfSpace plane{{}, sign > 0 ? box_.max[shortest] : -box_.min[shortest]};
      plane.normal.at(shortest) = sign;
      const Aabb& a = bodies_.surface(0).bvh.nodes[0].box;
      const bool of_a = (sign > 0 ? a.max[shortest] : -a.min[shortest]) <= plane.height;
      sum.emplace_back(number_of_plane(of_a ? 0 : 1, plane, INFINITY), 1.0);
    }
  }

  std::uint32_t number(const Term& term) {
    const Column& column = term.column;
    const Patch& patch = bodies_.patch(column.body, column.patch);
    if (column.plane) return number_of_plane(column.body, {patch.normal * column.sign, column.height}, term.reach);
    const auto [known, fresh] = patches_.try_emplace({column.body, column.patch}, next());
    if (fresh) {
      const auto triangles = bodies_.patches(column.body).triangles.begin() + patch.first_triangle;
      proof_.bounds.push_back({column.body, {triangles, triangles + patch.triangle_count}, {}, INFINITY});
    }
    return known->second;
  }

  std::uint32_t number_of_plane(int body, const HalfSpace& plane, double reach) {
    const Vec3 n = plane.normal;
    const auto [known, fresh] = planes_.try_emplace({body, n.x, n.y, n.z, plane.height, reach}, next());
    if (fresh) proof_.bounds.push_back({body, {}, plane, reach});
    return known->second;
  }

  std::uint32_t next() const { return static_cast<std::uint32_t>(proof_.bounds.size()); }

  const TwoBodies& bodies_;
  Aabb box_;
  ThicknessProof proof_;
  std::map<std::pair<int, std::uint32_t>, std::uint32_t> patches_;
  std::map<std::tuple<int, double, double, double, double, double>, std::uint32_t> planes_;
};

ThicknessProof ThicknessRecord::proof(const TwoBodies& bodies, Vec3 origin, const Aabb& box) const {
  return Writer(bodies, origin, box).write(nodes_);
}

}  // namespace satcheck
