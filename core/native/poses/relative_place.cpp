#include "poses/relative_place.hpp"

namespace satcheck {
namespace {

Mat3 inverse_of(const Mat3& m) {
  const Vec3 x = cross(m.row[1], m.row[2]), y = cross(m.row[2], m.row[0]), z = cross(m.row[0], m.row[1]);
  const double by = 1 / dot(m.row[0], x);
  return {{Vec3{x.x, y.x, z.x} * by, Vec3{x.y, y.y, z.y} * by, Vec3{x.z, y.z, z.z} * by}};
}

Mat3 product(const Mat3& m, const Mat3& n) {
  const auto row = [&](Vec3 r) { return transpose_times(n, r); };
  return {{row(m.row[0]), row(m.row[1]), row(m.row[2])}};
}

}  // namespace

Relative relative_place(const PosedPlace& at_a, Vec3 largest_a, const PosedPlace& at_b, Vec3 largest_b) {
  const Mat3 inverse = inverse_of(at_a.linear);
  Relative place{product(inverse, at_b.linear), inverse * (at_b.offset - at_a.offset)};
  place.size = sum(absolute(place.linear) * largest_b + absolute(place.offset)) + sum(largest_a);
  // How far the placement of A takes such a point from where the placement of B has it.
  const Mat3 back = product(at_a.linear, place.linear), terms = product(absolute(at_a.linear), absolute(place.linear));
  const Vec3 shift = at_a.linear * place.offset + at_a.offset - at_b.offset;
  const Vec3 shift_terms = absolute(at_a.linear) * absolute(place.offset) + absolute(at_a.offset) + absolute(at_b.offset);
  double error = sum(absolute(shift)) + kProductRounding * sum(shift_terms);
  for (int i = 0; i < 3; ++i) {
    const Vec3 wrong = absolute(back.row[i] - at_b.linear.row[i]);
    error += dot(wrong + (terms.row[i] + absolute(at_b.linear.row[i])) * kProductRounding, largest_b);
  }
  // Each coordinate in the world is rounded once.
  error += 2 * kUnitRoundoff * (at_a.reach + at_b.reach);
  place.slack = error / at_a.stretch.least * (1 + kProductRounding);
  return place;
}

}  // namespace satcheck
