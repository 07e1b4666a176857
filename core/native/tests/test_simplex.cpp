// Weights of the origin in tetrahedra as thin as support points of curved shapes make them.
#include "check.hpp"
#include "pairs.hpp"
#include "simplex.hpp"
#include "tolerances.hpp"

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
      if (closest_point(s).count != 0) continue;  // rounded, it may lie beside the origin
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

}  // namespace

int main() {
  test_weights_hold_the_origin();
  return testing::exit_status();
}
