// Sets against the convex narrow phase, which shares no code with them but the hull.
#include "depth/forbidden_set.hpp"

#include <random>

#include "convex/narrow_phase.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

void two_cubes() {
  const Mesh a = box({0, 0, 0}, {1, 1, 1}), b = box({0.75, 0, 0}, {2, 1, 1});
  const ForbiddenSet set = forbidden_set(a.vertices, b.vertices);
  const ForbiddenSet::Exit exit = set.exit({0, 0, 0});
  CHECK(std::fabs(exit.depth - 0.25) < 1e-12 && exit.depth <= 0.25);
  CHECK((exit.normal == Vec3{-1, 0, 0}));
  CHECK(set.exit({-0.5, 0, 0}).depth < 0);
  // The set is (-0.25, 2) x (-1, 1) x (-1, 1).
  CHECK(set.reach({0, 0, 0}, {0.125, 0.5, 0.5}).length == INFINITY);
  const ForbiddenSet::Reach cut = set.reach({0, 0, 0}, {0.5, 0.5, 0.5});
  CHECK(cut.meets && std::fabs(cut.length - 0.25) < 1e-12);
  const ForbiddenSet::Reach beside = set.reach({-1, 0, 0}, {0.5, 0.5, 0.5});
  CHECK(!beside.meets && beside.length == -INFINITY);
}

void no_volume_no_set() {
  const std::vector<Vec3> p{{0, 0, 0}, {1, 0, 0}}, q{{0, 0, 0}, {0, 1, 0}};
  CHECK(forbidden_set(p, q).empty());
  CHECK(forbidden_set(p, q).exit({0, 0, 0}).depth == -INFINITY);
  CHECK(!forbidden_set(p, q).reach({0, 0, 0}, {1, 1, 1}).meets);
}

void random_hulls() {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto cloud = [&](int count) {
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k) points.push_back({normal(random), normal(random), normal(random)});
    return points;
  };
  for (int k = 0; k < 200; ++k) {
    const std::vector<Vec3> p = cloud(4 + k % 20), q = cloud(4 + k % 13);
    const Shape a = make_hull(p), b = make_hull(q);
    const ForbiddenSet set = forbidden_set(p, q);
    const Vec3 t{normal(random), normal(random), normal(random)};
    const PairResult truth = check_pair(a, {{}, t}, b, {}, Query::depth);
    const ForbiddenSet::Exit exit = set.exit(t);
    CHECK((exit.depth > 0) == (truth.outcome == Outcome::penetrating));
    if (truth.outcome != Outcome::penetrating) continue;
    CHECK(exit.depth <= -truth.distance);
    CHECK(std::fabs(exit.depth + truth.distance) < 1e-11);
    CHECK(check_pair(a, {{}, t + exit.normal * (exit.depth + 1e-10)}, b, {}, Query::overlap).outcome != Outcome::penetrating);
  }
}

// Facets that a box does not reach say nothing about its points.
void sets_within_boxes() {
  const Mesh a = box({0, 0, 0}, {1, 1, 1}), b = box({0.75, 0, 0}, {2, 1, 1});
  const ForbiddenSet set = forbidden_set(a.vertices, b.vertices);
  const Vec3 centre{0, 0.875, 0}, half{0.5, 0.25, 0.5};
  const ForbiddenSet part = set.within(centre, half);
  const ForbiddenSet::Reach whole = set.reach(centre, half), reach = part.reach(centre, half);
  // Two triangles each of the facets x = -0.25 and y = 1.
  CHECK(set.normal.size() == 12 && part.normal.size() == 4 && whole.facets == 4 && reach.facets == 4);
  CHECK(reach.meets && reach.length == whole.length);
  for (const Vec3 t : {centre, Vec3{-0.375, 0.875, 0}, Vec3{0, 1.0625, 0.25}, Vec3{0.25, 0.75, -0.5}}) {
    CHECK((part.exit(t).depth > 0) == (set.exit(t).depth > 0));
  }
}

// Of a part of a box that counts as held, no point is outside; and two halves of a box that one set holds are held.
void parts_of_boxes() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(-1, 1);
  const auto point = [&] { return Vec3{at(random), at(random), at(random)}; };
  int held = 0;
  Budget budget;
  for (int k = 0; k < 2000; ++k) {
    std::vector<Vec3> p, q;
    for (int i = 0; i < 8; ++i) {
      p.push_back(point());
      q.push_back(point());
    }
    const ForbiddenSet set = forbidden_set(p, q);
    const Vec3 centre = point() * 0.6, half = Vec3{0.5 + at(random) / 3, 0.5 + at(random) / 3, 0.5 + at(random) / 3} * 0.6;
    const Vec3 direction = point(), normal = direction * (1 / norm(direction));
    const double offset = dot(normal, centre) + 0.3 * at(random);
    const double length = set.reach_beyond(centre, half, normal, offset, -INFINITY, budget);
    CHECK(length >= set.reach(centre, half).length);
    held += length == INFINITY && set.reach(centre, half).length < INFINITY;
    for (int i = 0; i < 20; ++i) {
      const Vec3 s = point(), t = centre + Vec3{s.x * half.x, s.y * half.y, s.z * half.z};
      if (dot(normal, t) < offset || norm(t) >= length) continue;
      CHECK(set.exit(t).depth > 0);
    }
  }
  CHECK(held > 20);
}

}  // namespace

UNIT(forbidden_set) {
  two_cubes();
  no_volume_no_set();
  random_hulls();
  sets_within_boxes();
  parts_of_boxes();
}
