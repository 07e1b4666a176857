// The shortest translations that keep walls, against answers by hand.
#include "ladder/least_motion.hpp"

#include <cmath>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

const Vec3 x{1, 0, 0}, y{0, 1, 0};

LeastMotion solved(std::vector<bool> movable, const std::vector<PairWall>& walls) {
  return least_motion(movable, walls, std::vector<double>(walls.size(), 0.0));
}

bool near(Vec3 a, Vec3 b, double tolerance = 1e-13) { return norm(a - b) <= tolerance; }

void two_free_bodies_share() {
  const auto found = solved({true, true}, {{0, 1, x, 1}});
  CHECK(found.translations[0] == (Vec3{0.5, 0, 0}));
  CHECK(found.translations[1] == (Vec3{-0.5, 0, 0}));
  CHECK(found.multipliers[0] == 0.5);
}

void a_body_that_stays_stays() {
  const auto found = solved({true, false}, {{0, 1, x, 1}});
  CHECK(found.translations[0] == x);
  CHECK(found.translations[1] == Vec3{});
}

void a_corner_is_left_to_the_last_bit() {
  const auto found = solved({true, false, false}, {{0, 1, x, 0.1}, {0, 2, y, 0.3}});
  CHECK(found.translations[0] == (Vec3{0.1, 0.3, 0}));
}

void a_wall_that_is_kept_pushes_nobody() {
  const auto found = solved({true, true}, {{0, 1, x, -1}});
  CHECK(found.translations[0] == Vec3{});
  CHECK(found.multipliers[0] == 0);
}

// Body k must be a unit further than body k - 1, the first one a unit from one that stays.
void a_chain_is_solved() {
  constexpr std::uint32_t length = 40;
  std::vector<bool> movable(length + 1, true);
  movable[0] = false;
  std::vector<PairWall> walls;
  for (std::uint32_t k = 1; k <= length; ++k) walls.push_back({k, k - 1, x, 1});
  const auto found = solved(movable, walls);
  for (std::uint32_t k = 0; k <= length; ++k) CHECK(near(found.translations[k], x * k, 1e-4));
  for (const PairWall& wall : walls) CHECK(dot(x, found.translations[wall.a] - found.translations[wall.b]) >= 1 - 1e-12);
}

void earlier_multipliers_do_not_change_the_answer() {
  const std::vector<PairWall> walls{{0, 1, x, 1}, {1, 2, x, 1}, {0, 2, y, 2}};
  const auto cold = solved({true, true, true}, walls);
  const auto warm = least_motion({true, true, true}, walls, {3, 0.5, 7});
  for (int k = 0; k < 3; ++k) CHECK(near(cold.translations[k], warm.translations[k], 1e-12));
}

void walls_that_exclude_each_other_end() {
  const auto found = solved({true, false, false}, {{0, 1, x, 1}, {2, 0, x, 1}});
  CHECK(std::isfinite(found.translations[0].x));
}

}  // namespace

UNIT(least_motion) {
  two_free_bodies_share();
  a_body_that_stays_stays();
  a_corner_is_left_to_the_last_bit();
  a_wall_that_is_kept_pushes_nobody();
  a_chain_is_solved();
  earlier_multipliers_do_not_change_the_answer();
  walls_that_exclude_each_other_end();
}
