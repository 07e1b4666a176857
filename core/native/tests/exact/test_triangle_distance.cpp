// Nearly parallel edges: the gap is known from how the triangles are made, for any angle.
#include "exact/triangle_distance.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

// Edge along x at height 0 with its face below, edge turned by `angle` about z at height `gap` with its
// face above: they pass each other over the origin.
Witnesses crossed_edges(double angle, double gap) {
  const Corners below{Vec3{-1, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 0, -1}};
  const Corners above{Vec3{-1, -angle, gap}, Vec3{1, angle, gap}, Vec3{0, 0, 1 + gap}};
  return triangle_distance(below, above);
}

void test_nearly_parallel_edges() {
  for (double angle : {1e-1, 1e-3, 1e-6, 1e-8, 1e-10}) {
    for (double gap : {1e-3, 1e-9, 1e-12}) {
      // The witness points carry a rounding error each, of the size 1, in every coordinate.
      CHECK(std::fabs(std::sqrt(crossed_edges(angle, gap).distance_squared) - gap) < 1e-15);
    }
  }
}

void test_off_centre() {
  // Away from the middle the place along the edges is no round number.
  const double angle = 1e-7, gap = 1e-9;
  const Corners below{Vec3{-1, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 0, -1}};
  const Vec3 shift{0.3, 0.3 * angle, 0};
  const Corners above{Vec3{-1, -angle, gap} + shift, Vec3{1, angle, gap} + shift, Vec3{0, 0, 1 + gap} + shift};
  CHECK(std::fabs(std::sqrt(triangle_distance(below, above).distance_squared) - gap) < 1e-15);
}

}  // namespace

int main() {
  test_nearly_parallel_edges();
  test_off_centre();
  return testing::exit_status();
}
