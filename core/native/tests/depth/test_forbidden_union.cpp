// Sets that are boxes, whose union is seen at a glance.
#include "depth/forbidden_union.hpp"

#include <cmath>

#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

constexpr double kLeast = 0.9;
const TranslationBox kBox{{0, 0, 0}, {0.5, 0.5, 0.5}, {}, 0};

// The open box between the corners: the difference of a larger box and the unit cube.
ForbiddenSet set_of(Vec3 low, Vec3 high) {
  return forbidden_set(box({0, 0, 0}, {1, 1, 1}).vertices, box(low + Vec3{1, 1, 1}, high).vertices);
}

ForbiddenUnion left_half(Budget& budget) {
  ForbiddenUnion sets(-1, budget);
  sets.add(set_of({-2, -1, -1}, {0.25, 1, 1}));
  return sets;
}

void one_set() {
  Budget budget;
  ForbiddenUnion sets = left_half(budget);
  TranslationBox cut = kBox;
  CHECK(sets.covered_by_one(cut, kLeast, kLeast) == -INFINITY);
  CHECK(cut.sets.size() == 1 && cut.seen == 1);
  CHECK(sets.covered_by_several(cut, kLeast) == -INFINITY);
  TranslationBox within{{-0.5, 0, 0}, {0.5, 0.5, 0.5}, {}, 0};
  CHECK(sets.covered_by_one(within, kLeast, kLeast) == INFINITY);
  TranslationBox beside{{1, 0, 0}, {0.5, 0.5, 0.5}, {}, 0};
  CHECK(sets.covered_by_one(beside, kLeast, kLeast) == -INFINITY);
  CHECK(beside.sets.empty());
}

void two_sets_cover_the_seam_between_them() {
  Budget budget;
  ForbiddenUnion sets = left_half(budget);
  sets.add(set_of({0.125, -1, -1}, {2, 1, 1}));
  TranslationBox cut = kBox;
  CHECK(sets.covered_by_one(cut, kLeast, kLeast) == -INFINITY);
  CHECK(cut.sets.size() == 2);
  CHECK(sets.covered_by_several(cut, kLeast) == INFINITY);
  CHECK(!sets.nearest_open(cut, {0, 0, 0}, kLeast));
  CHECK(sets.holds({0.1875, 0, 0}) && !sets.holds({0, 1.5, 0}));
}

void the_nearest_open_point() {
  Budget budget;
  ForbiddenUnion sets = left_half(budget);
  TranslationBox cut = kBox;
  sets.covered_by_one(cut, kLeast, kLeast);
  const auto open = sets.nearest_open(cut, {0, 0, 0}, kLeast);
  CHECK(open && open->x > 0.25 && open->x < 0.3 && open->y == 0 && open->z == 0);
  CHECK(sets.is_open(cut, *open, kLeast) && !sets.is_open(cut, {0, 0, 0}, kLeast));
  CHECK(!sets.is_open(cut, *open, 0.25));
  CHECK(std::fabs(sets.on_facets(cut).x - 0.25) < 1e-12);
  const ForbiddenSet::Exit exit = sets.deepest_exit({0, 0, 0});
  CHECK(std::fabs(exit.depth - 0.25) < 1e-12 && (exit.normal == Vec3{1, 0, 0}));
  CHECK(sets.deepest_exit(*open).depth == 0);
}

}  // namespace

UNIT(forbidden_union) {
  one_set();
  two_sets_cover_the_seam_between_them();
  the_nearest_open_point();
}
