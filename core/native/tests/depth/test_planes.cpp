// Nearest points beyond walls against projections onto random ones.
#include "depth/planes.hpp"

#include <random>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

bool is(const std::optional<Vec3>& found, Vec3 expected) { return found && norm(*found - expected) < 1e-12; }

void faces_edges_and_corners() {
  const Wall x{{1, 0, 0}, 1}, y{{0, 1, 0}, 2}, z{{0, 0, 1}, 3}, back{{-1, 0, 0}, 0.5};
  CHECK(is(nearest_beyond({}), {0, 0, 0}));
  CHECK(is(nearest_beyond({x}), {1, 0, 0}));
  CHECK(is(nearest_beyond({x, y}), {1, 2, 0}));
  CHECK(is(nearest_beyond({z, x, y}), {1, 2, 3}));
  CHECK(!nearest_beyond({x, back}));
  const Wall slant{{0.6, 0.8, 0}, 2};
  CHECK(is(nearest_beyond({x, slant}), {1.2, 1.6, 0}));
}

void no_nearer_point_is_beyond() {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    std::vector<Wall> walls;
    const auto violates = [&](Vec3 t) {
      for (const Wall& w : walls) {
        if (dot(w.normal, t) < w.offset - 1e-9) return true;
      }
      return false;
    };
    // As in use: each wall is one that the best point so far is not beyond.
    std::optional<Vec3> best = Vec3{};
    for (int n = 0; n < 6 && best; ++n) {
      const Vec3 v{normal(random), normal(random), std::fabs(normal(random)) + 1};
      const Vec3 unit = v * (1 / norm(v));
      walls.push_back({unit, dot(unit, *best) + 0.25});
      best = nearest_beyond(walls);
    }
    CHECK(best && !violates(*best));
    if (!best) continue;
    for (int n = 0; n < 200; ++n) {
      const Vec3 nearer = (*best + Vec3{normal(random), normal(random), normal(random)} * 0.05);
      if (norm(nearer) < norm(*best) * (1 - 1e-6)) CHECK(violates(nearer));
    }
  }
}

}  // namespace

UNIT(planes) {
  faces_edges_and_corners();
  no_nearer_point_is_beyond();
}
