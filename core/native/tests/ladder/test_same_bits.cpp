// 10,000 results over all queries, pinned as one hash: the same bits on every system and with every compiler. A change
// that is meant to change results pins the hash anew, and says why.
#include <bit>
#include <cstdio>
#include <random>

#include "convex/narrow_phase.hpp"
#include "depth/depth_search.hpp"
#include "mesh_pair/mesh_distance.hpp"
#include "motion/motion_search.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"
#include "thickness/thickness_search.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

constexpr std::uint64_t kPinned = 0xeceafaf220092c2e;
constexpr int kConvexPairs = 2600, kMeshPairs = 500, kMotions = 300;

// FNV-1a (Fowler, Noll, Vo 1991) of the bits, with one zero and one NaN.
class Hash {
 public:
  void add(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte) value_ = (value_ ^ (bits >> (8 * byte) & 0xff)) * 0x100000001b3;
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number != number ? 1.5 : number + 0.0)); }
  void add(Vec3 v) {
    for (int axis = 0; axis < 3; ++axis) add(v[axis]);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

// Numbers that the standard library of no system has a say in: the engine is prescribed, its distributions are not.
class Numbers {
 public:
  double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53); }
  Vec3 in_cube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Pose pose(double spread) {
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1), w = uniform(0.1, 1);
    const double k = 2 / (x * x + y * y + z * z + w * w);
    return {{{{1 - k * (y * y + z * z), k * (x * y - z * w), k * (x * z + y * w)},
              {k * (x * y + z * w), 1 - k * (x * x + z * z), k * (y * z - x * w)},
              {k * (x * z - y * w), k * (y * z + x * w), 1 - k * (x * x + y * y)}}},
            in_cube(spread)};
  }

 private:
  std::mt19937_64 engine_{20};
};

std::vector<Shape> shapes(Numbers& numbers) {
  std::vector<Shape> made{make_box({1, 0.5, 0.25}), make_sphere(0.7),        make_capsule(0.3, 0.8),
                          make_cylinder(0.6, 0.5),  make_cone(0.7, 0.6), make_ellipsoid({0.4, 0.7, 1})};
  for (const int count : {4, 8, 20, 90}) {
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k) points.push_back(numbers.in_cube(1));
    made.push_back(make_hull(points));
  }
  return made;
}

// Three results a pair.
void add_convex_pairs(Numbers& numbers, Hash& hash) {
  const std::vector<Shape> all = shapes(numbers);
  for (int k = 0; k < kConvexPairs; ++k) {
    const Shape &a = all[static_cast<std::size_t>(k) % all.size()], &b = all[static_cast<std::size_t>(k / 7) % all.size()];
    const Pose at = numbers.pose(0.2), to = numbers.pose(1.6);
    for (const Query query : {Query::overlap, Query::depth, Query::distance}) {
      const PairResult result = check_pair(a, at, b, to, query);
      hash.add(static_cast<std::uint64_t>(result.outcome));
      for (const double figure : {result.distance, result.lower, result.upper}) hash.add(figure);
      for (const Vec3 v : {result.normal, result.witness_a, result.witness_b}) hash.add(v);
    }
  }
}

// A box with a notch, which is not convex, placed.
Surface notched(const Pose& pose) {
  Mesh mesh = box({-1, -1, -1}, {0, 1, 1});
  append(mesh, box({0, -1, -1}, {1, 0, 1}));
  for (Vec3& vertex : mesh.vertices) vertex = pose * vertex;
  return make_surface(mesh, true);
}

// Relation and distance, or depth and thickness: three results a pair where the bodies overlap, else two.
int add_mesh_pairs(Numbers& numbers, Hash& hash) {
  int results = 0;
  for (int k = 0; k < kMeshPairs; ++k) {
    const Surface a = notched(numbers.pose(0.2)), b = notched(numbers.pose(2));
    const MeshRelation relation = mesh_relation(a, b);
    hash.add(static_cast<std::uint64_t>(relation.relation));
    ++results;
    if (relation.relation == Relation::separated) {
      const MeshDistance distance = mesh_distance(a, b, INFINITY);
      hash.add(distance.distance), hash.add(distance.witness_a), hash.add(distance.witness_b);
      ++results;
      continue;
    }
    DepthGoal depth_goal{.upper = 8};
    depth_goal.width = 0.2, depth_goal.work = 2'000'000;
    const DepthInterval depth = search_depth(a, b, depth_goal);
    hash.add(depth.lower), hash.add(depth.upper), hash.add(depth.way_out), hash.add(depth.work);
    ThicknessGoal thickness_goal;
    thickness_goal.width = 0.2, thickness_goal.work = 2'000'000;
    const ThicknessInterval thickness = search_thickness(a, b, thickness_goal);
    hash.add(thickness.lower), hash.add(thickness.upper), hash.add(thickness.centre), hash.add(thickness.work);
    results += 2;
  }
  return results;
}

// Two results a pair: of the shapes and of their meshes.
void add_motions(Numbers& numbers, Hash& hash) {
  const Shape shape = make_box({1, 1, 1});
  const Mesh mesh = box({-1, -1, -1}, {1, 1, 1});
  for (int k = 0; k < kMotions; ++k) {
    const Moving a{numbers.pose(0.2), numbers.in_cube(1), {}, numbers.in_cube(2)};
    const Moving b{numbers.pose(6), numbers.in_cube(1), k % 2 == 0 ? numbers.in_cube(2) : Vec3{}, {}};
    const MotionQuestion question = MotionQuestion::time(0.01, 1);
    hash.add(ask_motion(&shape, a, &shape, b, question, {1e-12, 1e-12}).value);
    Mesh placed[2] = {mesh, mesh};
    for (Vec3& vertex : placed[0].vertices) vertex = a.pose * vertex;
    for (Vec3& vertex : placed[1].vertices) vertex = b.pose * vertex;
    const Surface surface_a = make_surface(placed[0], true), surface_b = make_surface(placed[1], true);
    hash.add(ask_motion(&surface_a, a, &surface_b, b, question, {1e-12, 1e-12}, 10'000).value);
  }
}

}  // namespace

UNIT(same_bits) {
  Numbers numbers;
  Hash hash;
  add_convex_pairs(numbers, hash);
  const int of_meshes = add_mesh_pairs(numbers, hash);
  add_motions(numbers, hash);
  CHECK(3 * kConvexPairs + of_meshes + 2 * kMotions >= 9'500);
  if (!CHECK(hash.value() == kPinned)) std::fprintf(stderr, "the hash is 0x%llx\n", static_cast<unsigned long long>(hash.value()));
}
