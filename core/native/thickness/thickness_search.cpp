// Method: branch and bound over boxes of space, largest bound first. For triangles T_i of either mesh and weights
// lambda_i >= 0 of sum 1, sum lambda_i (dist(p, T_i) - e_i) is no smaller than the depth of p and convex in p, so its
// maximum over a box is at a corner. The weights that make this maximum least are those of a small matrix game, corners
// against triangles; the other player's weights give a point of the box, whose depth is a lower bound of the thickness
// and whose nearest triangles are the next columns of the game: James E. Kelley, "The Cutting-Plane Method for Solving
// Convex Programs" (1960).
#include "thickness/thickness_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/tolerances.hpp"
#include "base/work.hpp"
#include "depth/exact_centre.hpp"
#include "exact/triangle_distance.hpp"
#include "mesh/surface_order.hpp"
#include "mesh_pair/moved_surface.hpp"
#include "thickness/matrix_game.hpp"

namespace satcheck {
namespace {

// Measured steps of a triangle whose distance from a point or a box is taken, of a box, of a pivot, and between two calls of poll().
constexpr std::uint64_t kDistanceWork = 25, kFilterWork = 5, kBoxWork = 500, kGameWork = 1000, kPollWork = 50'000'000;

// The distance from a point to a triangle, in float64: a point is placed with a rounded normal (16 roundoffs of the
// distance) or on an edge (8), on a side of an edge that 9 roundoffs decide, of a distance below 4 times the largest
// coordinate; a difference and a root add 4. Rounded up.
constexpr double kDistanceRoundoffs = 256;

// Columns that are added to the game of a box before it is split.
constexpr int kColumnsPerBox = 12;

struct Column {
  int body;
  std::uint32_t triangle;
  bool operator==(const Column&) const = default;
};

struct Box {
  double bound = INFINITY;  // of the depth in it
  Aabb at;
  std::array<std::vector<std::uint32_t>, 2> near;  // triangles that can be nearest to a point of it
  std::vector<Column> columns;                     // that bounded the box it was split from
  std::array<double, 3> variation{};               // of the bound, along each axis
  std::uint64_t number = 0;
};

struct Smaller {
  bool operator()(const Box& a, const Box& b) const {
    return a.bound != b.bound ? a.bound < b.bound : a.number > b.number;
  }
};

// All of a body is at or behind the plane normal . p = height.
struct SupportPlane {
  Vec3 normal;
  double height;
};

struct Nearest {
  double depth = INFINITY;
  std::uint32_t triangle = 0;
};

double& coordinate(Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

Vec3 corner(const Aabb& box, int k) {
  return {k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z};
}

// Common to both, as wide as rounding may make it.
Aabb common_box(const Aabb& a, const Aabb& b) {
  return {{std::fmax(a.min.x, b.min.x), std::fmax(a.min.y, b.min.y), std::fmax(a.min.z, b.min.z)},
          {std::fmin(a.max.x, b.max.x), std::fmin(a.max.y, b.max.y), std::fmin(a.max.z, b.max.z)}};
}

class Search {
 public:
  // centre: was subtracted from both surfaces.
  Search(const Surface& a, const Surface& b, const ThicknessGoal& goal, Vec3 centre)
      : bodies_{&a, &b}, less_{goal.less_a, goal.less_b}, goal_(goal), centre_(centre) {
    double scale = 0;
    for (const Surface* body : bodies_) {
      scale = std::fmax(scale, std::fmax(max_abs(body->bvh.nodes[0].box.min), max_abs(body->bvh.nodes[0].box.max)));
    }
    rounding_ = kDistanceRoundoffs * kUnitRoundoff * scale;
    floor_ = 0.0 - std::fmax(goal.less_a, goal.less_b);
    best_ = floor_;
    dropped_ = floor_;
  }

  ThicknessInterval run() {
    push_root();
    while (!open_.empty()) {
      if (finish(open_.top().bound)) return result_;
      Box box = open_.top();
      open_.pop();
      split(box);
    }
    finish(floor_);
    return result_;
  }

 private:
  std::uint64_t work() const { return work_done - start_; }

  // A box whose bound is no larger does not have to be split.
  double enough() const {
    const double narrow = best_ > 0 ? best_ / (1 - goal_.width) : best_;
    return goal_.limit ? std::fmax(narrow, *goal_.limit / 2) : narrow;
  }

  // Whether the interval is good enough, or the work is spent, if no open box has a larger bound.
  bool finish(double open) {
    const double upper = std::fmax(std::fmax(open, dropped_), best_);
    result_.lower = 2 * best_;
    result_.upper = 2 * upper;
    result_.work = work();
    const bool decided = goal_.limit && (result_.lower > *goal_.limit || result_.upper <= *goal_.limit);
    const bool narrow = upper - best_ <= goal_.width * std::fabs(upper) || open_.empty();
    result_.stop = decided ? ThicknessStop::decided : narrow ? ThicknessStop::narrow : ThicknessStop::work_spent;
    if (decided || narrow || work() >= goal_.work) return true;
    if (goal_.poll && work() >= next_poll_) {
      next_poll_ = work() + kPollWork;
      goal_.poll();
    }
    return false;
  }

  // No ball in both is larger than the box that is common to their boxes.
  void push_root() {
    Box root;
    root.at = common_box(bodies_[0]->bvh.nodes[0].box, bodies_[1]->bvh.nodes[0].box);
    double half = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
      if (root.at.max[axis] < root.at.min[axis]) return;
      if (axis != goal_.across) half = std::fmin(half, (root.at.max[axis] - root.at.min[axis]) / 2);
    }
    root.bound = half + std::fmax(less_[0], less_[1]) - std::fmin(less_[0], less_[1]) + rounding_;
    if (goal_.across >= 0) {
      const double middle = (root.at.min[goal_.across] + root.at.max[goal_.across]) / 2;
      coordinate(root.at.min, goal_.across) = coordinate(root.at.max, goal_.across) = middle;
    }
    for (int body = 0; body < 2; ++body) {
      const double reach = root.bound + less_[body] + 2 * rounding_;
      const Aabb wide{root.at.min - Vec3{reach, reach, reach}, root.at.max + Vec3{reach, reach, reach}};
      visit_box(bodies_[body]->bvh, bodies_[body]->mesh, wide, [&](std::uint32_t t) {
        if (counts(body, t)) root.near[body].push_back(t);
        return true;
      });
      std::sort(root.near[body].begin(), root.near[body].end());
    }
    add(std::move(root));
  }

  // Ends of prisms do not count in the plane.
  bool counts(int body, std::uint32_t t) const {
    if (goal_.across < 0) return true;
    const Aabb box = triangle_box(bodies_[body]->mesh, t);
    return box.min[goal_.across] != box.max[goal_.across];
  }

  // Bounds the box, and keeps it if its bound is too large.
  void add(Box box) {
    ++result_.boxes;
    work_done += kBoxWork;
    bool outside = false;
    for (int body = 0; body < 2 && !outside; ++body) {
      const bool met = keep_near(box, body);
      outside = !met && is_outside(body, middle(box.at));
    }
    const double bound = outside ? floor_ : std::fmin(box.bound, bound_of(box));
    box.bound = bound;
    if (bound <= enough()) {
      dropped_ = std::fmax(dropped_, bound);
      return;
    }
    box.number = next_number_++;
    open_.push(std::move(box));
  }

  static Vec3 middle(const Aabb& box) { return box.min * 0.5 + box.max * 0.5; }

  bool is_outside(int body, Vec3 p) const {
    const auto winding = winding_number(*bodies_[body], p);
    return winding && *winding == 0;
  }

  bool is_inside(int body, Vec3 p) const {
    const auto winding = winding_number(*bodies_[body], p);
    return winding && *winding != 0;
  }

  // Leaves out triangles that are too far from the box to matter. Whether one may meet it.
  bool keep_near(Box& box, int body) const {
    const double reach = box.bound + less_[body] + 2 * rounding_;
    std::vector<std::uint32_t>& near = box.near[body];
    work_done += kFilterWork * near.size();
    bool met = false;
    std::erase_if(near, [&](std::uint32_t t) {
      const double gap = box_distance_squared(triangle_box(bodies_[body]->mesh, t), box.at);
      met = met || gap == 0;
      return gap > reach * reach;
    });
    return met;
  }

  double distance(int body, std::uint32_t t, Vec3 p) const {
    return norm(nearest_on_triangle(p, corners(bodies_[body]->mesh, t)) - p);
  }

  // A convex function of p that is no smaller than the depth of p in the body, if p is inside.
  double payment(Column column, Vec3 p) {
    const auto& plane = support_plane(column);
    const double depth = plane ? plane->height - dot(plane->normal, p) : distance(column.body, column.triangle, p);
    return depth - less_[static_cast<std::size_t>(column.body)];
  }

  // Where the body ends at the triangle's plane: nothing of it lies beyond.
  const std::optional<SupportPlane>& support_plane(Column column) {
    const auto [known, fresh] = planes_[static_cast<std::size_t>(column.body)].try_emplace(column.triangle);
    if (!fresh) return known->second;
    const Mesh& mesh = bodies_[static_cast<std::size_t>(column.body)]->mesh;
    const auto t = corners(mesh, column.triangle);
    const Vec3 normal = rounded_normal(t[0], t[1], t[2]);
    const double length = norm(normal);
    if (!(length > 0)) return known->second;
    SupportPlane plane{normal * (1 / length), -INFINITY};
    work_done += mesh.vertices.size();
    for (const Vec3 p : mesh.vertices) plane.height = std::fmax(plane.height, dot(plane.normal, p));
    if (plane.height - dot(plane.normal, t[0]) <= rounding_) known->second = plane;
    return known->second;
  }

  // Of a point of the box.
  Nearest nearest(const Box& box, int body, Vec3 p) const {
    Nearest best;
    work_done += kDistanceWork * box.near[body].size();
    for (const std::uint32_t t : box.near[body]) {
      const double depth = distance(body, t, p) - less_[body];
      if (depth < best.depth) best = {depth, t};
    }
    return best;
  }

  // An upper bound of the depth of all points in the box. Leaves the triangles that it rests on and its variation in the box.
  double bound_of(Box& box) {
    // A plane through the box pays no less: what goes beyond is cut off.
    const double floor = floor_ - norm(box.at.max - box.at.min) - rounding_;
    MatrixGame game(8, floor);
    std::vector<Column> columns;
    std::vector<double> payments;  // 8 a column
    const auto add_column = [&](Column column) {
      if (std::find(columns.begin(), columns.end(), column) != columns.end()) return false;
      columns.push_back(column);
      for (int k = 0; k < 8; ++k) payments.push_back(std::fmax(payment(column, corner(box.at, k)), floor));
      work_done += 8 * kDistanceWork;
      game.add({payments.data() + payments.size() - 8, 8});
      return true;
    };
    for (const Column& column : box.columns) add_column(column);
    if (columns.empty() && !add_nearest(box, middle(box.at), add_column)) return box.bound;
    double bound = INFINITY;
    for (int round = 0; round < kColumnsPerBox; ++round) {
      game.solve();
      work_done += kGameWork;
      bound = std::fmin(bound, proven(game.column_weights(), payments));
      if (bound <= enough()) break;
      Vec3 p;
      for (int k = 0; k < 8; ++k) p = p + corner(box.at, k) * game.row_weights()[static_cast<std::size_t>(k)];
      if (!add_nearest(box, p, add_column)) break;
    }
    rank(box, columns, payments, game.column_weights());
    return bound;
  }

  // The largest weighted sum at a corner, rounding included.
  double proven(const std::vector<double>& weights, const std::vector<double>& payments) const {
    double total = 0, bound = -INFINITY;
    for (const double weight : weights) total += weight;
    for (std::size_t k = 0; k < 8; ++k) {
      double sum = 0;
      for (std::size_t c = 0; c < weights.size(); ++c) sum += weights[c] * payments[8 * c + k];
      bound = std::fmax(bound, sum / total);
    }
    return bound + 2 * rounding_;
  }

  // The nearest triangles of both bodies become columns. Whether one is new.
  template <class AddColumn>
  bool add_nearest(const Box& box, Vec3 p, AddColumn add_column) {
    const Nearest a = nearest(box, 0, p), b = nearest(box, 1, p);
    const double depth = std::fmin(std::fmin(a.depth, b.depth), box.bound);
    if (depth > best_) consider(box, p);
    bool added = false;
    if (a.depth <= b.depth && a.depth < INFINITY) added = add_column({0, a.triangle});
    if (b.depth <= a.depth && b.depth < INFINITY) added = add_column({1, b.triangle}) || added;
    return added;
  }

  // A lower bound of the thickness, if p is in both. p is first rounded to a point of the world frame.
  void consider(const Box& box, Vec3 p) {
    const Vec3 world = p + centre_;
    p = world - centre_;
    double depth = box.bound - 2 * rounding_, radius = INFINITY;
    for (int body = 0; body < 2; ++body) {
      const double near = nearest(box, body, p).depth;
      depth = std::fmin(depth, near);
      radius = std::fmin(radius, std::fmin(near, box.bound) + less_[body]);
    }
    depth -= 2 * rounding_;
    if (!(depth > best_) || !is_inside(0, p) || !is_inside(1, p)) return;
    best_ = depth;
    result_.found = true;
    result_.centre = world;
    result_.radius = radius - 2 * rounding_;
  }

  // The columns that count, and how much their sum varies along each axis.
  void rank(Box& box, const std::vector<Column>& columns, const std::vector<double>& payments, const std::vector<double>& weights) {
    box.columns.clear();
    box.variation = {};
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (weights[c] <= 0) continue;
      box.columns.push_back(columns[c]);
      for (int axis = 0; axis < 3; ++axis) {
        double variation = 0;
        for (std::size_t k = 0; k < 8; ++k) {
          const std::size_t across = k ^ (std::size_t{1} << axis);
          variation = std::fmax(variation, std::fabs(payments[8 * c + k] - payments[8 * c + across]));
        }
        box.variation[static_cast<std::size_t>(axis)] += weights[c] * variation;
      }
    }
  }

  void split(const Box& box) {
    int axis = 0;
    for (int i = 1; i < 3; ++i) {
      if (box.variation[static_cast<std::size_t>(i)] > box.variation[static_cast<std::size_t>(axis)]) axis = i;
    }
    if (!(box.at.max[axis] > box.at.min[axis]) || box.variation[static_cast<std::size_t>(axis)] <= rounding_) {
      const Vec3 size = box.at.max - box.at.min;
      axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    }
    const double at = middle(box.at)[axis];
    if (!(at > box.at.min[axis] && at < box.at.max[axis])) {  // nothing is left to split
      dropped_ = std::fmax(dropped_, box.bound);
      return;
    }
    Box low = box, high = box;
    coordinate(low.at.max, axis) = at;
    coordinate(high.at.min, axis) = at;
    add(std::move(low));
    add(std::move(high));
  }

  std::array<const Surface*, 2> bodies_;
  std::array<double, 2> less_;
  ThicknessGoal goal_;
  Vec3 centre_;
  std::uint64_t start_ = work_done;
  double rounding_, floor_, best_, dropped_;
  ThicknessInterval result_;
  std::priority_queue<Box, std::vector<Box>, Smaller> open_;
  std::array<std::map<std::uint32_t, std::optional<SupportPlane>>, 2> planes_;
  std::uint64_t next_number_ = 0, next_poll_ = kPollWork;
};

ThicknessInterval search_in_order(const Surface& a, const Surface& b, const ThicknessGoal& goal) {
  const Vec3 centre = exact_centre(a, b);
  if (centre == Vec3{}) return Search(a, b, goal, centre).run();
  MovedSurface moved_a(a), moved_b(b);
  return Search(moved_a.at(-centre), moved_b.at(-centre), goal, centre).run();
}

}  // namespace

ThicknessInterval search_thickness(const Surface& a, const Surface& b, const ThicknessGoal& goal) {
  if (!a.solid || !b.solid) throw std::invalid_argument("the thickness of an overlap needs two solids");
  if (comes_before(a, b)) return search_in_order(a, b, goal);
  ThicknessGoal swapped = goal;
  std::swap(swapped.less_a, swapped.less_b);
  return search_in_order(b, a, swapped);
}

}  // namespace satcheck
