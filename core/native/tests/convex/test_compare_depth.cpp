// The exact verdict on small integer polytopes, where float64 distances tell the three cases apart with
// room to spare: integer polytopes of coordinates up to 4 are either in contact or at least 1/|n| apart
// (or deep), n an integer normal no longer than 100.
#include <random>

#include "convex/exact_depth.hpp"
#include "convex/exact_distance.hpp"
#include "convex/gjk.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

using Points = std::vector<Vec3>;

constexpr double kLeast = 1e-2;

// -1 apart, 0 touching, 1 overlapping.
int sign(const Points& a, const Points& b) { return compare_depth(ExactDifference(a, b), Dyadic()); }

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
  int apart = 0, touching = 0, overlapping = 0, freed = 0;
  for (int round = 0; round < testing::rounds(1500); ++round) {
    const Points a = random_points(engine, count(engine), {0, 0, 0});
    const Points b = random_points(engine, count(engine), {double(shift(engine)), double(shift(engine)), double(shift(engine))});
    const int found = sign(a, b);
    ++(found < 0 ? apart : found == 0 ? touching : overlapping);
    CHECK(sign(b, a) == found);
    CHECK((compare_distance(ExactDifference(a, b), Dyadic()) > 0) == (found < 0));
    CHECK((gap_between(a, b) == Gap::open) == (found < 0));
    // The nudges are a grid of 729: a touching pair with a narrow way out may be missed by all of them,
    // so only the share that is freed is checked below.
    const bool free = found >= 0 && some_nudge_frees(a, b);
    if (found > 0) CHECK(!free);
    freed += found == 0 && free;
  }
  const int least = testing::kSanitized ? 1 : 50;
  CHECK(apart >= 2 * least && touching >= least && overlapping >= 2 * least);  // all three were met
  CHECK(freed >= touching * 9 / 10);
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
      CHECK(sign(a, b) == -steps);
      CHECK(steps >= 0 || compare_depth(ExactDifference(a, b), Dyadic(ulp)) == 0);
    }
  }
}

}  // namespace

UNIT(compare_depth) {
  test_integer_polytopes();
  test_one_ulp();
}
