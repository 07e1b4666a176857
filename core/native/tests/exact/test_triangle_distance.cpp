// Nearly parallel edges: the gap is known from how the triangles are made, for any angle. Needles and slivers.
#include "exact/triangle_distance.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

// Edge along x at height 0 with its face below, edge turned by `angle` about z at height `gap` with its
// face above: they pass each other over the origin.
NearestPoints crossed_edges(double angle, double gap) {
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

// The cross product of its long edges is off in the ninth digit. The distance is that of the float64 points, in rationals.
void test_a_needle() {
  const Corners needle{Vec3{0.1, -0.5, 0.7}, Vec3{0.9, -1.2, 0.1}, Vec3{0.9, -1.1999999, 0.1}};
  const Vec3 p{0.633333343, -0.966666633, 0.3};
  CHECK(std::fabs(norm(nearest_on_triangle(p, needle) - p) - 5.7999999858449055e-09) < 1e-15);
  CHECK(std::fabs(std::sqrt(triangle_distance(needle, {p, p, p}).distance_squared) - 5.7999999858449055e-09) < 1e-15);
}

// Beyond the end of a triangle that is a line but for rounding, on which side of an edge a point lies is noise.
void test_beyond_the_end_of_a_sliver() {
  const Corners sliver{Vec3{0.2, 0.0, 0.7}, Vec3{-0.6000000000000001, 0.6999999999999998, 1.5}, Vec3{-0.20000000000000012, 0.35, 1.1}};
  const Vec3 p{-3.0, 2.8, 3.9000000000000004};
  CHECK(norm(nearest_on_triangle(p, sliver) - p) == norm(sliver[1] - p));
  CHECK(triangle_distance({p, p, p}, sliver).distance_squared == norm_squared(sliver[1] - p));
}

}  // namespace

UNIT(triangle_distance) {
  test_nearly_parallel_edges();
  test_off_centre();
  test_a_needle();
  test_beyond_the_end_of_a_sliver();
}
