// Weights of the origin in tetrahedra as thin as support points of curved shapes make them; the closest point where
// the last vertex is needed against the plain one.
#include "base/rounding.hpp"
#include "convex/simplex.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

// One corner far off and three on a short arc, which bends by the square of its width: what a support
// point and its neighbours on a rim or a mantle span.
Simplex splinter(testing::Source& source, double width) {
  const Mat3 turn = source.rotation();
  Vec3 corner[4] = {{-source.uniform(0.1, 1), 0, 0}};
  double weight[4] = {1, 0, 0, 0};
  for (int i = 1; i < 4; ++i) {
    const double along = width * source.uniform(-1, 1);
    corner[i] = {1, along, along * along};
    weight[i] = source.uniform(0.1, 1);
    weight[0] += weight[i];
  }
  Vec3 inside;
  for (int i = 0; i < 4; ++i) inside = inside + corner[i] * ((i == 0 ? 1 : weight[i]) / weight[0]);
  Simplex s;
  for (const Vec3& p : corner) {
    SupportPoint point{};
    point.w = turn * (p - inside);
    s.add(point);
  }
  return s;
}

void test_weights_hold_the_origin() {
  testing::Source source(3);
  // An arc of width w leaves a gap of about w^2 / 8: narrower ones GJK does not reach.
  const double narrowest = std::sqrt(8 * kCurvedGap);
  for (double width = 1; width > narrowest; width /= 2) {
    for (int k = 0; k < 50; ++k) {
      Simplex s = splinter(source, width);
      if (!closest_point(s).encloses()) continue;  // rounded, it may lie beside the origin
      weigh_enclosed_origin(s);
      double sum = 0;
      for (int i = 0; i < s.count; ++i) {
        CHECK(s.weight[i] >= 0);
        sum += s.weight[i];
      }
      CHECK(std::fabs(sum - 1) <= 1e-15);
      CHECK(norm(s.witness_a() - s.witness_b()) <= 64 * kUnitRoundoff);
    }
  }
}

Simplex random_simplex(testing::Source& source, int count) {
  Simplex s;
  for (int i = 0; i < count; ++i) {
    SupportPoint point{};
    point.w = source.on_sphere() * source.uniform(0.1, 1) + Vec3{0.2, 0, 0};
    s.add(point);
  }
  return s;
}

void test_the_last_vertex_is_enough_where_it_is_needed() {
  testing::Source source(5);
  int needed = 0;
  for (int k = 0; k < 3000; ++k) {
    const Simplex s = random_simplex(source, 2 + k % 3);
    const SupportPoint* p = s.vertex;
    const ClosestPoint plain = closest_point(s), stepped = closest_point<true>(p[0].w, p[1].w, p[2].w, p[3].w, s.count);
    if (!plain.encloses() && (plain.carriers >> (s.count - 1) & 1) == 0) continue;
    ++needed;
    CHECK(stepped.distance_squared == plain.distance_squared);
    CHECK(stepped.carriers == plain.carriers);
  }
  CHECK(needed > 500);
}

void test_the_enclosed_ball_is_enclosed() {
  testing::Source source(7);
  int enclosing = 0;
  for (int k = 0; k < 3000; ++k) {
    const Simplex s = random_simplex(source, 4);
    const double radius = enclosed_radius(s.vertex[0].w, s.vertex[1].w, s.vertex[2].w, s.vertex[3].w);
    if (!closest_point(s).encloses()) {
      CHECK(radius <= 0);
      continue;
    }
    ++enclosing;
    for (int skip = 0; skip < 4; ++skip) {
      const Vec3 p = s.vertex[(skip + 1) % 4].w, q = s.vertex[(skip + 2) % 4].w, r = s.vertex[(skip + 3) % 4].w;
      const Vec3 n = cross(q - p, r - p);
      CHECK(radius < std::fabs(dot(n, p)) / norm(n));
    }
  }
  CHECK(enclosing > 30);
}

}  // namespace

UNIT(simplex) {
  test_the_last_vertex_is_enough_where_it_is_needed();
  test_the_enclosed_ball_is_enclosed();
  test_weights_hold_the_origin();
}
