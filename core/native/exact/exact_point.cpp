#include "exact/exact_point.hpp"

#include <limits>
#include <utility>

#include "exact/predicates.hpp"

namespace satcheck {
namespace {

constexpr double kRoundoff = std::numeric_limits<double>::epsilon() / 2;

// rounded_ratio() is within 2 ulp; 8 u also covers the roundings of the box made from it.
constexpr double kPointError = 8 * kRoundoff;

// As in predicates.cpp.
constexpr double kDeterminantBound = 9 * kRoundoff;

// Covers the roundings of the error term itself.
constexpr double kSlack = 1.001;

bool is_float64(const ExactPoint& p) { return p.error == Vec3{}; }

Dyadic minor(const Dyadic& a, const Dyadic& b, const Dyadic& c, const Dyadic& d) {
  return a * d - b * c;
}

}  // namespace

ExactPoint make_exact_point(Vec3 p) { return {p.x, p.y, p.z, 1.0, p, {}}; }

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

ExactPoint between(const ExactPoint& p, const ExactPoint& q, const Dyadic& wp, const Dyadic& wq) {
  const Dyadic sp = wp * q.w, sq = wq * p.w;
  return make_exact_point(p.x * sp + q.x * sq, p.y * sp + q.y * sq, p.z * sp + q.z * sq,
                          (wp + wq) * p.w * q.w);
}

namespace {

// The plane through a, b and c: value(p) has the sign of orientation(a, b, c, p).
class ExactPlane {
 public:
  ExactPlane(Vec3 a, Vec3 b, Vec3 c) : ax_(a.x), ay_(a.y), az_(a.z) {
    const Dyadic ux = b.x - ax_, uy = b.y - ay_, uz = b.z - az_;
    const Dyadic vx = c.x - ax_, vy = c.y - ay_, vz = c.z - az_;
    nx_ = minor(uy, uz, vy, vz);
    ny_ = minor(uz, ux, vz, vx);
    nz_ = minor(ux, uy, vx, vy);
  }

  Dyadic value(Vec3 p) const { return nx_ * (p.x - ax_) + ny_ * (p.y - ay_) + nz_ * (p.z - az_); }

 private:
  Dyadic ax_, ay_, az_, nx_, ny_, nz_;
};

}  // namespace

Dyadic orientation_value(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return ExactPlane(a, b, c).value(d); }

ExactPoint plane_meeting_point(Vec3 a, Vec3 b, Vec3 c, Vec3 p, Vec3 q) {
  const ExactPlane plane(a, b, c);
  const Dyadic wp = plane.value(q), wq = -plane.value(p);
  return make_exact_point(wp * p.x + wq * q.x, wp * p.y + wq * q.y, wp * p.z + wq * q.z, wp + wq);
}

bool operator==(const ExactPoint& p, const ExactPoint& q) {
  if (!meet(point_box(p), point_box(q))) return false;
  return (p.x * q.w - q.x * p.w).sign() == 0 && (p.y * q.w - q.y * p.w).sign() == 0 &&
         (p.z * q.w - q.z * p.w).sign() == 0;
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

  if (is_float64(d)) return orientation(a, b, c, d.rounded);
  const Dyadic ax = a.x, ay = a.y, az = a.z;
  const Dyadic ux = b.x - ax, uy = b.y - ay, uz = b.z - az;
  const Dyadic vx = c.x - ax, vy = c.y - ay, vz = c.z - az;
  return (minor(uy, uz, vy, vz) * (d.x - ax * d.w) + minor(uz, ux, vz, vx) * (d.y - ay * d.w) +
          minor(ux, uy, vx, vy) * (d.z - az * d.w))
      .sign();
}

namespace {

// A point of a plane as float64 knows it.
struct Known {
  Vec3 at, error;
};

// The sign, where float64 can tell; 2 where it cannot.
int filtered_orientation_2d(Known a, Known b, Known c, int drop_axis) {
  const auto [i, j] = plane_axes(drop_axis);
  const Vec3 u = b.at - a.at, v = c.at - a.at;
  const Vec3 eu = a.error + b.error, ev = a.error + c.error;
  const double left = u[i] * v[j], right = u[j] * v[i];
  const auto product_error = [](double x, double ex, double y, double ey) {
    return std::fabs(x) * ey + std::fabs(y) * ex + ex * ey;
  };
  const double bound =
      kSlack * (kDeterminantBound * (std::fabs(left) + std::fabs(right)) +
                product_error(u[i], eu[i], v[j], ev[j]) + product_error(u[j], eu[j], v[i], ev[i]));
  return left - right > bound ? 1 : left - right < -bound ? -1 : 2;
}

}  // namespace

int orientation_2d_at(Vec3 a, Vec3 b, const ExactPoint& p, int drop_axis) {
  const int sign = filtered_orientation_2d({a, {}}, {b, {}}, {p.rounded, p.error}, drop_axis);
  return sign != 2 ? sign : orientation_2d_at(make_exact_point(a), make_exact_point(b), p, drop_axis);
}

int orientation_2d_at(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int drop_axis) {
  if (is_float64(a) && is_float64(b) && is_float64(c)) {
    return orientation_2d(a.rounded, b.rounded, c.rounded, drop_axis);
  }
  const int sign = filtered_orientation_2d({a.rounded, a.error}, {b.rounded, b.error}, {c.rounded, c.error}, drop_axis);
  return sign != 2 ? sign : area_value(a, b, c, drop_axis).sign();
}

Dyadic area_value(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int drop_axis) {
  const auto [i, j] = plane_axes(drop_axis);
  const auto difference = [&](const ExactPoint& p, int axis) {
    return coordinate(p, axis) * a.w - coordinate(a, axis) * p.w;
  };
  return minor(difference(b, i), difference(b, j), difference(c, i), difference(c, j));
}

}  // namespace satcheck
