// The exact verdict on small integer polytopes, where float64 distances tell the three cases apart with
// room to spare: integer polytopes of coordinates up to 4 are either in contact or at least 1/|n| apart
// (or deep), n an integer normal no longer than 100.
#include <random>

#include "base/rounding.hpp"
#include "convex/convex_hull.hpp"
#include "convex/exact_depth.hpp"
#include "convex/exact_pair.hpp"
#include "convex/gjk.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

using Points = std::vector<Vec3>;

constexpr double kSlack = 1e-13;  // several support errors at this size
constexpr double kLeast = 1e-2;

Outcome decide(const Points& a, const Points& b, double slack) {
  return decide_exactly(convex_hull(a), convex_hull(b), slack);
}

Points random_points(std::mt19937& engine, int count, Vec3 shift) {
  std::uniform_int_distribution<int> coordinate(0, 4);
  Points points;
  for (int i = 0; i < count; ++i) {
    const Vec3 p{double(coordinate(engine)), double(coordinate(engine)), double(coordinate(engine))};
    points.push_back(p + shift);
  }
  return points;
}

// Separated or not, by GJK's bounds alone.
enum class Gap { open, closed };
Gap gap_between(const Points& a, const Points& b) {
  const Shape sa = make_hull(a), sb = make_hull(b);
  const GjkResult g = gjk(MinkowskiDifference(sa, {}, sb, {}));
  if (g.status == GjkResult::Status::separated) {
    CHECK(g.lower > kLeast);
    return Gap::open;
  }
  return Gap::closed;
}

// Pushing A by a little along any of many directions opens a gap or leaves the overlap: touching pairs
// come free for some direction, penetrating ones for none.
bool some_nudge_frees(const Points& a, const Points& b) {
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) {
      for (int z = -4; z <= 4; ++z) {
        Points moved = a;
        for (Vec3& p : moved) p = p + Vec3{double(x), double(y), double(z)} * 1e-5;
        const Shape sa = make_hull(moved), sb = make_hull(b);
        if (gjk(MinkowskiDifference(sa, {}, sb, {})).status == GjkResult::Status::separated) return true;
      }
    }
  }
  return false;
}

void test_integer_polytopes() {
  std::mt19937 engine(5);
  std::uniform_int_distribution<int> shift(-4, 4), count(1, 9);
  int outcomes[4] = {0, 0, 0, 0};
  for (int round = 0; round < testing::rounds(1500); ++round) {
    const Points a = random_points(engine, count(engine), {0, 0, 0});
    const Points b = random_points(engine, count(engine), {double(shift(engine)), double(shift(engine)), double(shift(engine))});
    const Outcome outcome = decide(a, b, kSlack);
    ++outcomes[static_cast<int>(outcome)];
    CHECK(decide(b, a, kSlack) == outcome);
    CHECK((gap_between(a, b) == Gap::open) == (outcome == Outcome::separated));
    if (outcome == Outcome::penetrating) CHECK(!some_nudge_frees(a, b));
    // The nudges are a grid of 729: a touching pair with a narrow way out may be missed by all of them,
    // so only the share that is freed is checked below.
    if (outcome == Outcome::touching && some_nudge_frees(a, b)) ++outcomes[3];
  }
  const int least = testing::kSanitized ? 1 : 50;
  CHECK(outcomes[0] >= 2 * least && outcomes[1] >= least && outcomes[2] >= 2 * least);  // all three were met
  CHECK(outcomes[3] >= outcomes[1] * 9 / 10);
}

// Rounding bends the faces of turned polytopes, so that those of flush ones cross. The exact depth decides the same independently.
void test_turned_polytopes() {
  std::mt19937 engine(6);
  testing::Source source(6);
  std::uniform_int_distribution<int> shift(-4, 4), count(6, 12);
  int shallow = 0;
  for (int round = 0; round < testing::rounds(400); ++round) {
    Points a = random_points(engine, count(engine), {0, 0, 0});
    Points b = random_points(engine, count(engine), {double(shift(engine)), double(shift(engine)), double(shift(engine))});
    const Pose pose = source.pose(1);
    for (Vec3& p : a) p = pose * p;
    for (Vec3& p : b) p = pose * p;
    const Polytope hull_a = convex_hull(a), hull_b = convex_hull(b);
    const Outcome outcome = decide_exactly(hull_a, hull_b, kSlack);
    CHECK(decide_exactly(hull_b, hull_a, kSlack) == outcome);
    if (outcome == Outcome::separated || hull_a.dimension < 3 || hull_b.dimension < 3) continue;
    const ExactDifference difference(hull_a.vertices, hull_b.vertices);
    CHECK((compare_depth(difference, Dyadic(0x1p-300)) > 0) == (outcome == Outcome::penetrating));
    shallow += outcome == Outcome::penetrating && compare_depth(difference, Dyadic(kSlack)) < 0;
  }
  CHECK(shallow >= testing::rounds(10));
}

void test_one_ulp() {
  const Points cube = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  for (double far : {0.0, 0x1p20, 0x1p40}) {
    Points a = cube;
    for (Vec3& p : a) p.x += far;
    const double ulp = std::nextafter(far + 1, INFINITY) - (far + 1);
    for (int steps : {-1, 0, 1}) {
      Points b;
      for (Vec3 p : cube) b.push_back({far + 1 + steps * ulp + p.x, p.y * 0.5 + 0.25, p.z + 0.125});
      for (Vec3& p : b) p.x = p.x > far + 1.5 ? far + 2 : p.x;
      const Outcome expected = steps < 0 ? Outcome::penetrating : steps == 0 ? Outcome::touching : Outcome::separated;
      CHECK(decide(a, b, kSupportError * (far + 4)) == expected);
    }
  }
}

}  // namespace

UNIT(exact_pair) {
  test_integer_polytopes();
  test_turned_polytopes();
  test_one_ulp();
}
