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

}  // namespace

int main() {
  two_cubes();
  no_volume_no_set();
  random_hulls();
  return exit_status();
}
