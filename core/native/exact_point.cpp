#include "exact_point.hpp"

#include <limits>
#include <utility>

namespace satcheck {
namespace {

constexpr double kRoundoff = std::numeric_limits<double>::epsilon() / 2;

// rounded_ratio() is within 2 ulp; 8 u also covers the roundings of the box made from it.
constexpr double kPointError = 8 * kRoundoff;

// As in predicates.cpp.
constexpr double kDeterminantBound = 9 * kRoundoff;

// Covers the roundings of the error term itself.
constexpr double kSlack = 1.001;

Dyadic minor(const Dyadic& a, const Dyadic& b, const Dyadic& c, const Dyadic& d) {
  return a * d - b * c;
}

}  // namespace

ExactPoint make_exact_point(Dyadic x, Dyadic y, Dyadic z, Dyadic w) {
  ExactPoint p;
  if (w.sign() < 0) {
    x = -x;
    y = -y;
    z = -z;
    w = -w;
  }
  p.rounded = {rounded_ratio(x, w), rounded_ratio(y, w), rounded_ratio(z, w)};
  const auto error = [](double value) {
    return kPointError * std::fabs(value) + std::numeric_limits<double>::min();
  };
  p.error = {error(p.rounded.x), error(p.rounded.y), error(p.rounded.z)};
  p.x = std::move(x);
  p.y = std::move(y);
  p.z = std::move(z);
  p.w = std::move(w);
  return p;
}

ExactPoint weighted_point(Vec3 a, Vec3 b, Vec3 c, const Dyadic& wa, const Dyadic& wb,
                          const Dyadic& wc) {
  return make_exact_point(wa * a.x + wb * b.x + wc * c.x, wa * a.y + wb * b.y + wc * c.y,
                          wa * a.z + wb * b.z + wc * c.z, wa + wb + wc);
}

int orientation(Vec3 a, Vec3 b, Vec3 c, const ExactPoint& d) {
  const Vec3 u = b - a, v = c - a, p = d.rounded - a;
  const double yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z, xy = u.x * v.y,
               yx = u.y * v.x;
  const Vec3 size{std::fabs(yz) + std::fabs(zy), std::fabs(zx) + std::fabs(xz),
                  std::fabs(xy) + std::fabs(yx)};
  const double determinant = (yz - zy) * p.x + (zx - xz) * p.y + (xy - yx) * p.z;
  const Vec3 span{std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)};
  const double bound = kSlack * (kDeterminantBound * dot(size, span) + dot(size, d.error));
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;

  const Dyadic ax = a.x, ay = a.y, az = a.z;
  const Dyadic ux = b.x - ax, uy = b.y - ay, uz = b.z - az;
  const Dyadic vx = c.x - ax, vy = c.y - ay, vz = c.z - az;
  return (minor(uy, uz, vy, vz) * (d.x - ax * d.w) + minor(uz, ux, vz, vx) * (d.y - ay * d.w) +
          minor(ux, uy, vx, vy) * (d.z - az * d.w))
      .sign();
}

int orientation_2d_at(Vec3 a, Vec3 b, const ExactPoint& p, int drop_axis) {
  const int i = drop_axis == 2 ? 0 : drop_axis + 1;
  const int j = drop_axis == 0 ? 2 : drop_axis - 1;
  const auto coordinate = [&](int axis) -> const Dyadic& {
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
  };
  const Dyadic ai = a[i], aj = a[j];
  return minor(b[i] - ai, b[j] - aj, coordinate(i) - ai * p.w, coordinate(j) - aj * p.w).sign();
}

}  // namespace satcheck
