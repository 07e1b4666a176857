// Carried boxes hold what they carry, and an axis that is said to separate does: held against the convex solver on
// the same boxes, and against their corners.
#include "ladder/oriented_box.hpp"

#include <random>

#include "base/rounding.hpp"
#include "convex/narrow_phase.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

using Matrix = std::array<double, 16>;

std::mt19937 generator(7);

double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator); }

Mat3 random_turn() {
  Vec3 x{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}, y{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
  x = x * (1 / norm(x));
  y = y - x * dot(x, y);
  y = y * (1 / norm(y));
  return {{x, y, cross(x, y)}};
}

Matrix matrix_of(const Mat3& turn, Vec3 stretch, Vec3 shift) {
  Matrix m{};
  for (int row = 0; row < 3; ++row) {
    m[4 * row] = turn.row[row].x * stretch.x;
    m[4 * row + 1] = turn.row[row].y * stretch.y;
    m[4 * row + 2] = turn.row[row].z * stretch.z;
    m[4 * row + 3] = shift[row];
  }
  m[15] = 1;
  return m;
}

Vec3 apply(const Matrix& m, Vec3 p) {
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
          m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

std::vector<Vec3> corners_of(const Aabb& box) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back({i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z});
  }
  return corners;
}

const Aabb kBox{{-1, 0, 2}, {3, 0.5, 2.5}};

void corners_lie_in_the_box_and_fill_it() {
  for (const Vec3 stretch : {Vec3{1, 1, 1}, Vec3{2, 0.5, 3}, Vec3{1, -1, 1}}) {
    for (const Vec3 shift : {Vec3{}, Vec3{1e6, -3, 5}}) {
      const Matrix m = matrix_of(random_turn(), stretch, shift);
      const OrientedBox carried = carried_box(kBox, &m, 0);
      CHECK(carried.is_box && carried.turned);
      const double rounding = chain_rounding(max_abs(shift) + 10);
      for (const Vec3 corner : corners_of(kBox)) {
        for (int axis = 0; axis < 3; ++axis) {
          const double reach = std::fabs(dot(carried.axis[axis], apply(m, corner) - carried.centre));
          CHECK(reach <= carried.half[axis]);
          CHECK(carried.half[axis] - reach <= 2 * rounding + 1e-10);
        }
      }
    }
  }
}

void boxes_are_padded() {
  const Matrix m = matrix_of(random_turn(), {1, 1, 1}, {});
  const Vec3 grown = carried_box(kBox, &m, 0.5).half - carried_box(kBox, &m, 0).half;
  CHECK(max_abs(grown - Vec3{0.5, 0.5, 0.5}) < 1e-15);
}

void some_boxes_say_nothing_new() {
  CHECK(!carried_box(kBox, nullptr, 0).turned);
  const Matrix moved = matrix_of({}, {1, 1, 1}, {5, 6, 7});
  CHECK(!carried_box(kBox, &moved, 0).turned && carried_box(kBox, &moved, 0).is_box);
  Matrix sheared = moved;
  sheared[1] = 0.5;
  CHECK(!carried_box(kBox, &sheared, 0).is_box);
}

// The hull of the corners of an oriented box.
Shape hull_of(const OrientedBox& box) {
  std::vector<Vec3> corners;
  for (const Vec3 s : corners_of({{-1, -1, -1}, {1, 1, 1}})) {
    corners.push_back(box.centre + box.axis[0] * (s.x * box.half.x) + box.axis[1] * (s.y * box.half.y) +
                      box.axis[2] * (s.z * box.half.z));
  }
  return make_hull(corners);
}

OrientedBox random_box(double spread, bool nearly_aligned) {
  Mat3 turn = random_turn();
  if (nearly_aligned) {  // edges of two such boxes are all but parallel
    const double angle = uniform(-1, 1) * std::pow(10.0, uniform(-9, -3));
    turn = {{{std::cos(angle), -std::sin(angle), 0}, {std::sin(angle), std::cos(angle), 0}, {0, 0, 1}}};
  }
  const Vec3 half{uniform(0.05, 1), uniform(0.05, 1), uniform(0.05, 1)};
  const Matrix m = matrix_of(turn, {1, 1, 1}, {uniform(-spread, spread), uniform(-spread, spread), uniform(-spread, spread)});
  return carried_box({-half, half}, &m, 0);
}

double gap_along(const OrientedBox& a, const OrientedBox& b, const SeparatingAxis& axis) {
  const Vec3 n = axis.axis_b < 0   ? a.axis[axis.axis_a]
                 : axis.axis_a < 0 ? b.axis[axis.axis_b]
                                   : cross(a.axis[axis.axis_a], b.axis[axis.axis_b]);
  double reach = 0;
  for (const OrientedBox* box : {&a, &b}) {
    for (int i = 0; i < 3; ++i) reach += box->half[i] * std::fabs(dot(n, box->axis[i]));
  }
  return std::fabs(dot(n, b.centre - a.centre)) - reach;
}

void separating_axes_separate() {
  int apart = 0, meet = 0, by_edges = 0;
  for (int round = 0; round < 4000; ++round) {
    const bool aligned = round % 4 == 0;
    const OrientedBox a = random_box(1.2, aligned), b = random_box(1.2, aligned);
    const SeparatingAxis axis = separating_axis(a, b), other = separating_axis(b, a);
    const Feature feature = axis.feature, reverse = other.feature;
    const PairResult truth = check_pair(hull_of(a), {}, hull_of(b), {}, Query::distance, MethodChoice::gjk);
    if (feature != Feature::none) CHECK(truth.outcome == Outcome::separated);
    if (truth.distance > 1e-9) CHECK(feature != Feature::none);
    const bool mirrored = feature == Feature::face_a   ? reverse == Feature::face_b
                          : feature == Feature::face_b ? reverse == Feature::face_a
                                                       : reverse == feature;
    CHECK(mirrored && axis.axis_a == other.axis_b && axis.axis_b == other.axis_a);
    if (feature != Feature::none) CHECK(gap_along(a, b, axis) > 0);
    ++(feature == Feature::none ? meet : apart);
    by_edges += feature == Feature::edge_edge;
  }
  CHECK(apart > 1000 && meet > 300 && by_edges > 10);
}

}  // namespace

UNIT(oriented_box) {
  corners_lie_in_the_box_and_fill_it();
  boxes_are_padded();
  some_boxes_say_nothing_new();
  separating_axes_separate();
}
