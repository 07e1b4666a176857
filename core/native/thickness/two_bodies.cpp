#include "thickness/two_bodies.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <span>

#include "base/rounding.hpp"
#include "exact/triangle_distance.hpp"

namespace satcheck {
namespace {

// Measured steps of a patch that is held against a plane.
constexpr std::uint64_t kSideWork = 5;

// So many triangles usually belong to kManyPatches.
constexpr std::size_t kManyTriangles = 2 * kManyPatches;

// The distance from a point to a triangle, in float64: a point is placed with a rounded normal (16 roundoffs of the
// distance) or on an edge (8), on a side of an edge that 9 roundoffs decide, of a distance below 4 times the largest
// coordinate; a difference and a root add 4. Rounded up.
constexpr double kDistanceRoundoffs = 256;

Vec3 farthest_corner(const Aabb& box, Vec3 along) {
  return {along.x > 0 ? box.max.x : box.min.x, along.y > 0 ? box.max.y : box.min.y, along.z > 0 ? box.max.z : box.min.z};
}

double farthest(std::span<const Vec3> points, Vec3 normal) {
  double most = -INFINITY;
  for (const Vec3 p : points) most = larger(most, dot(normal, p));
  return most;
}

// Of a convex polygon, the largest normal . x in the box: the polygon, cut by the six sides of the box where that may
// make it smaller than `enough`.
double farthest_in(std::span<const Vec3> polygon, const Aabb& box, Vec3 normal, double enough) {
  const double most = farthest(polygon, normal);
  if (most <= enough) return most;
  std::vector<Vec3> shape(polygon.begin(), polygon.end()), cut;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const double wall = sign > 0 ? box.max[axis] : -box.min[axis];
      if (std::all_of(shape.begin(), shape.end(), [&](Vec3 p) { return sign * p[axis] <= wall; })) continue;
      cut.clear();
      for (std::size_t i = 0; i < shape.size(); ++i) {
        const Vec3 p = shape[i], q = shape[i + 1 < shape.size() ? i + 1 : 0];
        const double s = sign * p[axis] - wall, t = sign * q[axis] - wall;
        if (s <= 0) cut.push_back(p);
        if ((s < 0 && t > 0) || (s > 0 && t < 0)) cut.push_back(p + (q - p) * (s / (s - t)));
      }
      std::swap(shape, cut);
    }
  }
  return farthest(shape, normal);
}

}  // namespace

TwoBodies::TwoBodies(const Surface& a, const Surface& b, const ThicknessGoal& goal)
    : surfaces_{&a, &b}, less_{goal.less_a, goal.less_b}, across_(goal.across) {
  for (const Surface* surface : surfaces_) {
    scale_ = larger(scale_, surface->bvh.nodes[0].box.largest_coordinate());
  }
  rounding_ = kDistanceRoundoffs * kUnitRoundoff * scale_;
}

// In the plane, the ends of a prism do not count.
bool TwoBodies::counts(int body, std::uint32_t triangle) const {
  if (across_ < 0) return true;
  const Aabb box = triangle_box(surface(body).mesh, triangle);
  return box.min[across_] != box.max[across_];
}

Aabb TwoBodies::widened(const Aabb& box, double reach) const {
  const auto along = [&](int axis) { return axis == across_ ? 0.0 : reach; };
  const Vec3 wide{along(0), along(1), along(2)};
  return {box.min - wide, box.max + wide};
}

void TwoBodies::make_patches(const Aabb& box, double reach, double flatness) {
  for (int body = 0; body < 2; ++body) {
    const Surface& from = surface(body);
    std::vector<bool> is_near(from.mesh.triangles.size(), false);
    visit_box(from.bvh, from.mesh, box.widened(reach), [&](std::uint32_t t) {
      is_near[t] = counts(body, t);
      return true;
    });
    std::vector<std::uint32_t> triangles;
    triangles.reserve(static_cast<std::size_t>(std::count(is_near.begin(), is_near.end(), true)));
    for (std::uint32_t t = 0; t < is_near.size(); ++t) {
      if (is_near[t]) triangles.push_back(t);
    }
    patches_[static_cast<std::size_t>(body)] = convex_patches(from.mesh, triangles, flatness);
  }
}

PatchList TwoBodies::patches_at(int body, const Aabb& box, Budget& budget, std::size_t most) const {
  // A bit for each patch, and one for each word of these: sorting the list takes longer.
  std::vector<std::uint64_t> is_met(patches(body).patches.size() / 64 + 1, 0), is_used(is_met.size() / 64 + 1, 0);
  const Surface& from = surface(body);
  std::size_t met = 0;
  visit_box(from.bvh, from.mesh, box, [&](std::uint32_t t) {
    const std::uint32_t i = patches(body).patch_of[t];
    if (i == kNoIndex) return true;
    is_met[i / 64] |= std::uint64_t{1} << (i % 64);
    is_used[i / 4096] |= std::uint64_t{1} << (i / 64 % 64);
    return ++met < most;
  }, &budget);
  PatchList list;
  const auto each_bit = [](const std::vector<std::uint64_t>& words, std::size_t word, auto visit) {
    for (std::uint64_t bits = words[word]; bits != 0; bits &= bits - 1) {
      visit(64 * word + static_cast<std::size_t>(std::countr_zero(bits)));
    }
  };
  for (std::size_t group = 0; group < is_used.size(); ++group) {
    each_bit(is_used, group, [&](std::size_t word) {
      each_bit(is_met, word, [&](std::size_t i) { list.push_back(static_cast<std::uint32_t>(i)); });
    });
  }
  return list;
}

PatchList TwoBodies::patches_near(int body, const Aabb& box, Budget& budget, const PatchList* known) const {
  PatchList list;
  if (known != nullptr && !may_be_part(*known)) {
    budget.spend(kFilterWork * known->size());
    std::copy_if(known->begin(), known->end(), std::back_inserter(list), [&](auto i) { return meet(this->box(body, i), box); });
    return list;
  }
  if (!in_plane()) list = patches_at(body, box, budget, kManyTriangles);
  return may_be_part(list) ? list : patches_at(body, box, budget);
}

double TwoBodies::value(const Column& column, Vec3 p) const {
  const Patch& from = patch(column.body, column.patch);
  const double depth = column.plane ? column.height - column.sign * dot(from.normal, p)
                                    : patches(column.body).distance(from, p) + from.slack;
  return depth - less(column.body);
}

bool TwoBodies::is_inside(int body, Vec3 p, Budget& budget) const {
  const auto winding = winding_number(surface(body), p, &budget);
  return winding && *winding != 0;
}

bool TwoBodies::is_outside(int body, Vec3 p, Budget& budget) const {
  const auto winding = winding_number(surface(body), p, &budget);
  return winding && *winding == 0;
}

double TwoBodies::clearance(int body, Vec3 p, Budget& budget) const {
  if (across_ < 0) return nearest_point(surface(body), p, &budget).distance - rounding_;
  double least = INFINITY;
  const Mesh& mesh = surface(body).mesh;
  budget.spend(kDistanceWork * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (counts(body, t)) least = smaller(least, norm(nearest_on_triangle(p, corners(mesh, t)) - p));
  }
  return least - rounding_;
}

double TwoBodies::farthest(int body, const Aabb& box, Vec3 normal, const PatchList& near, double least, double enough,
                           Budget& budget) const {
  if (near.size() >= kManyPatches) return farthest_in_tree(body, box, normal, least, enough, budget);
  const auto compare = [&](std::uint32_t number) {
    const Patch& from = patch(body, number);
    const Aabb around = this->box(body, number);
    if (dot(normal, farthest_corner(around, normal)) <= least || !meet(around, box)) return;
    const Vec3* outline = patches(body).outlines.data() + from.first;
    least = larger(least, farthest_in({outline, from.count}, box, normal, enough) + from.slack);
  };
  for (const std::uint32_t number : near) {
    budget.spend(kSideWork);
    compare(number);
    if (least > enough) break;
  }
  return least;
}

double TwoBodies::farthest_in_tree(int body, const Aabb& box, Vec3 normal, double least, double enough, Budget& budget) const {
  const Surface& from = surface(body);
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty() && least <= enough) {
    const BvhNode& node = from.bvh.nodes[stack.back()];
    stack.pop_back();
    budget.spend(kNodeWork);
    if (!meet(node.box, box) || dot(normal, farthest_corner(common_box(node.box, box), normal)) <= least) continue;
    if (!node.is_leaf()) {
      const bool left_first = dot(normal, farthest_corner(from.bvh.nodes[node.first].box, normal)) >
                              dot(normal, farthest_corner(from.bvh.nodes[node.first + 1].box, normal));
      stack.push_back(node.first + (left_first ? 1 : 0));
      stack.push_back(node.first + (left_first ? 0 : 1));
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::uint32_t t = from.bvh.order[i];
      if (patches(body).patch_of[t] == kNoIndex || !meet(box_at(from.bvh, from.mesh, i), box)) continue;
      budget.spend(kSideWork);
      const Corners c = corners(from.mesh, t);
      least = larger(least, farthest_in(c, box, normal, larger(least, enough)));
    }
  }
  return least;
}

std::optional<Column> TwoBodies::plane_column(int body, std::uint32_t number, const Aabb& box, const PatchList& near,
                                              double tolerance, Budget& budget) const {
  const Patch& from = patch(body, number);
  if (norm_squared(from.normal) == 0) return std::nullopt;
  for (const double sign : {1.0, -1.0}) {
    const Vec3 normal = from.normal * sign;
    const double plane = dot(normal, patches(body).origin(from)) + from.slack;
    double height = farthest(body, box, normal, near, plane, plane + tolerance, budget);
    if (height > plane + tolerance) continue;
    height += rounding_;
    const Vec3 corner = farthest_corner(box, normal);
    if (dot(normal, corner) > height && !is_outside(body, corner, budget)) continue;
    return Column{number, true, body, height, sign};
  }
  return std::nullopt;
}

}  // namespace satcheck
