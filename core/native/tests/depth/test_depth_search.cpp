// The depth of unions of boxes, against the nearest free cell of their translations.
#include "depth/depth_search.hpp"

#include "base/rounding.hpp"
#include "mesh/transform.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "tests/check.hpp"
#include "tests/depth/free_cells.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

// Whole coordinates below 16, and lengths below 32: a few roundings of the search.
constexpr double kRounding = 64 * 32 * kUnitRoundoff;

struct Pair {
  WholeBoxes boxes_a, boxes_b;
  Surface a, b;
  double depth;  // 0: no overlap
};

Pair random_pair(std::mt19937& generator) {
  const auto count = [&] { return std::uniform_int_distribution<int>(1, 3)(generator); };
  const WholeBoxes a = random_boxes(generator, count(), 5), b = random_boxes(generator, count(), 5);
  return {a, b, make_surface(mesh_of(a), true), make_surface(mesh_of(b), true), overlap_after(a, b, {}) ? slow_depth(a, b) : 0};
}

// Out of the box of the other one along x.
double known_way_out(const Pair& p) { return p.a.bvh.nodes[0].box.max.x - p.b.bvh.nodes[0].box.min.x; }

void holds_the_truth() {
  std::mt19937 generator(23);
  int narrow = 0, overlapping = 0;
  for (int round = 0; round < rounds(240); ++round) {
    const Pair p = random_pair(generator);
    if (p.depth == 0) continue;
    ++overlapping;
    const DepthGoal goal{.upper = known_way_out(p), .width = 0.01, .work = 200'000'000};
    const DepthInterval found = search_depth(p.a, p.b, goal);
    CHECK(found.lower <= p.depth + kRounding && found.upper >= p.depth - kRounding);
    CHECK(found.bound >= found.upper && found.upper <= goal.upper);
    if (found.stop == SearchStop::narrow) {
      ++narrow;
      CHECK(found.upper - found.lower <= 0.01 * found.upper + kRounding);
    } else {
      CHECK(found.stop == SearchStop::work_spent && found.work >= goal.work);
    }
    if (found.has_way_out) {
      CHECK(norm(found.way_out) <= found.bound);
      const Surface moved = make_surface(translate(p.a.mesh, found.way_out), true);
      const Relation after = overlap_relation(moved, p.b).relation;
      CHECK(after == Relation::separated || after == Relation::touching);
    }
    const DepthInterval mirrored = search_depth(p.b, p.a, goal);
    CHECK(mirrored.lower == found.lower && mirrored.upper == found.upper && mirrored.way_out == -found.way_out);
  }
  // A slit as wide as the body is found by luck only; the others end.
  std::printf("depths of boxes: %d of %d narrow\n", narrow, overlapping);
  CHECK(narrow > overlapping / 2);
}

// Steps that are added change no step before them.
void gains_by_more_work() {
  std::mt19937 generator(25);
  for (int round = 0; round < rounds(60); ++round) {
    const Pair p = random_pair(generator);
    if (p.depth == 0) continue;
    DepthInterval before;
    for (const std::uint64_t work : {1'000'000, 5'000'000, 8'000'000, 16'000'000, 50'000'000, 100'000'000, 200'000'000}) {
      const DepthInterval found = search_depth(p.a, p.b, {.upper = known_way_out(p), .width = 0.001, .work = work});
      CHECK(found.upper <= before.upper && found.lower >= before.lower);
      before = found;
    }
  }
}

// A limit below the depth is decided; one above it leaves the interval narrow.
void stops_at_a_limit() {
  std::mt19937 generator(24);
  int decided = 0;
  for (int round = 0; round < rounds(60); ++round) {
    const Pair p = random_pair(generator);
    if (p.depth == 0) continue;
    const DepthGoal goal{.upper = known_way_out(p), .width = 1e-3, .work = 100'000'000, .limit = 0.5 * p.depth};
    const DepthInterval found = search_depth(p.a, p.b, goal);
    CHECK(found.lower <= p.depth + kRounding);
    decided += found.stop == SearchStop::decided;
    if (found.stop == SearchStop::decided) CHECK(found.lower >= goal.limit - kRounding);
  }
  CHECK(decided > 0);
}

// Along two axes only.
void in_a_plane() {
  const Surface tall = make_surface(box({0, 0, 0}, {2, 2, 9}), true), low = make_surface(box({1, -4, 8}, {9, 4, 10}), true);
  const DepthGoal free{.upper = 9, .work = 100'000'000}, flat{.upper = 9, .work = 100'000'000, .across = 2};
  CHECK(std::fabs(search_depth(tall, low, free).upper - 1) < 0.011);
  const Surface wide = make_surface(box({-9, -4, 8}, {9, 4, 10}), true);
  const DepthInterval around = search_depth(tall, wide, flat), under = search_depth(tall, wide, free);
  CHECK(under.lower <= 1 && under.upper >= 1 && under.upper < 1.011);
  CHECK(around.lower <= 4 && around.upper >= 4 && around.upper < 4.041);
}

}  // namespace

UNIT(depth_search) {
  holds_the_truth();
  gains_by_more_work();
  stops_at_a_limit();
  in_a_plane();
}
