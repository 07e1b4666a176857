// Signs against integer truth on small grids, and against known truth one ulp off degenerate planes.
#include "exact/predicates.hpp"

#include <random>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

using Integer = long long;

int sign(Integer value) { return (value > 0) - (value < 0); }

struct Lattice {
  Integer x, y, z;
};

Vec3 scaled_point(Lattice p, double unit) { return {p.x * unit, p.y * unit, p.z * unit}; }

Integer determinant(Lattice a, Lattice b, Lattice c, Lattice d) {
  const Lattice u{b.x - a.x, b.y - a.y, b.z - a.z};
  const Lattice v{c.x - a.x, c.y - a.y, c.z - a.z};
  const Lattice w{d.x - a.x, d.y - a.y, d.z - a.z};
  return w.x * (u.y * v.z - u.z * v.y) + w.y * (u.z * v.x - u.x * v.z) +
         w.z * (u.x * v.y - u.y * v.x);
}

// Both ways to ask for the side of a point.
int side(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const int sign = orientation(a, b, c, d);
  CHECK(TrianglePlane(a, b, c).side(d) == sign);
  return sign;
}

void small_grid_matches_integer_truth() {
  std::mt19937 generator(1);
  std::uniform_int_distribution<int> coordinate(-3, 3);
  const auto point = [&] { return Lattice{coordinate(generator), coordinate(generator), coordinate(generator)}; };
  for (int i = 0; i < 100000; ++i) {
    const Lattice a = point(), b = point(), c = point(), d = point();
    const int truth = sign(determinant(a, b, c, d));
    for (const double unit : {1.0, 0x1p-300, 0x1p+300}) {
      CHECK(side(scaled_point(a, unit), scaled_point(b, unit), scaled_point(c, unit), scaled_point(d, unit)) == truth);
    }
  }
}

// Coordinates k + n 2^-20 with large k: the float64 determinant is mostly rounding noise.
void large_lattice_matches_integer_truth() {
  std::mt19937 generator(2);
  std::uniform_int_distribution<int> offset(-2, 2);
  const Lattice u{1 << 19, 3, -(1 << 18)}, v{7, 1 << 18, 1 << 17};
  for (int i = 0; i < 100000; ++i) {
    const Lattice a{offset(generator), offset(generator), offset(generator)};
    const Lattice b{a.x + u.x, a.y + u.y, a.z + u.z}, c{a.x + v.x, a.y + v.y, a.z + v.z};
    Lattice d{a.x + u.x + v.x, a.y + u.y + v.y, a.z + u.z + v.z};
    d.x += offset(generator);
    d.y += offset(generator);
    d.z += offset(generator);
    const int truth = sign(determinant(a, b, c, d));
    CHECK(side(scaled_point(a, 0x1p-20), scaled_point(b, 0x1p-20), scaled_point(c, 0x1p-20), scaled_point(d, 0x1p-20)) ==
          truth);
  }
}

// The plane x + y + z = 3 * 0.1 sampled at permutations of three decimals, and the next float64 up.
void one_ulp_off_a_plane() {
  const Vec3 a{0.1, 0.2, 0.3}, b{0.2, 0.3, 0.1}, c{0.3, 0.1, 0.2};
  for (const Vec3 on : {Vec3{0.1, 0.3, 0.2}, Vec3{0.2, 0.1, 0.3}, Vec3{0.3, 0.2, 0.1}}) {
    CHECK(side(a, b, c, on) == 0);
    Vec3 above = on, below = on;
    above.z = std::nextafter(above.z, 1.0);
    below.z = std::nextafter(below.z, 0.0);
    const int up = side(a, b, c, above);
    CHECK(up != 0);
    CHECK(side(a, b, c, below) == -up);
    CHECK(side(b, a, c, above) == -up);
  }
}

void determinant_of_unrelated_rows() {
  const Vec3 o{1e10, -1e10, 3};
  CHECK(determinant_sign(o, o + Vec3{1, 0, 0}, {}, {0, 1, 0}, o, o + Vec3{0, 0, 1}) == 1);
  CHECK(determinant_sign({}, {0, 1, 0}, o, o + Vec3{1, 0, 0}, o, o + Vec3{0, 0, 1}) == -1);
  CHECK(determinant_sign({}, {1, 2, 3}, o, o + Vec3{2, 4, 6}, {}, {5, 7, 11}) == 0);
}

void planar_orientation() {
  const Vec3 o{}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  CHECK(orientation_2d(o, x, y, 2) == 1);
  CHECK(orientation_2d(o, y, z, 0) == 1);
  CHECK(orientation_2d(o, z, x, 1) == 1);
  CHECK(orientation_2d(o, y, x, 2) == -1);
  const Vec3 far{1e17, 1e17, 0};
  CHECK(orientation_2d({0.1, 0.1, 0}, far, {0.3, 0.3, 0}, 2) == 0);
  CHECK(orientation_2d({0.1, 0.1, 0}, far, {0.3, std::nextafter(0.3, 1.0), 0}, 2) == 1);
}

// One by one and together: the same bits.
void affine_sums_of_many_points() {
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> coordinate(-10, 10);
  const auto point = [&] { return Vec3{coordinate(generator), coordinate(generator), coordinate(generator)}; };
  for (std::size_t count = 0; count < 40; ++count) {
    const Vec3 row[3] = {point(), point(), point()}, offset = point();
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(point());
    std::vector<Vec3> placed = points;
    round_affine(row, offset, placed);
    for (std::size_t i = 0; i < count; ++i) {
      CHECK((placed[i] == Vec3{rounded_affine(row[0], points[i], offset.x), rounded_affine(row[1], points[i], offset.y),
                              rounded_affine(row[2], points[i], offset.z)}));
    }
  }
}

}  // namespace

UNIT(predicates) {
  small_grid_matches_integer_truth();
  large_lattice_matches_integer_truth();
  one_ulp_off_a_plane();
  determinant_of_unrelated_rows();
  planar_orientation();
  affine_sums_of_many_points();
}
