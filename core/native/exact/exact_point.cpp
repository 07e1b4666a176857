#include "exact/exact_point.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "exact/dyadic.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

constexpr double kRoundoff = std::numeric_limits<double>::epsilon() / 2;

// rounded_ratio() is within 2 ulp; 8 u also covers the roundings of the box made from it.
constexpr double kPointError = 8 * kRoundoff;

// Covers the roundings of the error term itself.
constexpr double kSlack = 1.001;

// Measured steps of an exact sign: of any, of each digit of the point, of each pair of them.
constexpr std::uint64_t kSignWork = 600, kDigitWork = 20, kDigitProductWork = 2;
// The same in a plane, and of two coordinates; then for each pair of digits of the longest point.
constexpr std::uint64_t kAreaWork = 100, kAreaDigitsWork = 8, kCompareWork = 80, kCompareDigitsWork = 2;

double point_error(double coordinate) {
  return kPointError * std::fabs(coordinate) + std::numeric_limits<double>::min();
}

bool is_float64(const ExactPoint& p) { return p.error == Vec3{}; }

std::uint64_t digits_of(const ExactPoint& p) { return std::max({p.x.digits(), p.y.digits(), p.z.digits(), p.w.digits()}); }

}  // namespace

std::uint64_t sign_work(const ExactPoint& p) {
  const std::uint64_t digits = digits_of(p);
  return kSignWork + kDigitWork * digits + kDigitProductWork * digits * digits;
}

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
  p.error = {point_error(p.rounded.x), point_error(p.rounded.y), point_error(p.rounded.z)};
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
  ExactPlane(Vec3 a, Vec3 b, Vec3 c) : a_(a), normal_(cross(DyadicVec(b) - a_, DyadicVec(c) - a_)) {}

  Dyadic value(Vec3 p) const { return dot(normal_, DyadicVec(p) - a_); }
  Dyadic value(const ExactPoint& p) const { return dot(normal_, DyadicVec(p.x, p.y, p.z) - a_ * p.w); }  // times p.w

 private:
  DyadicVec a_, normal_;
};

}  // namespace

Dyadic orientation_value(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return ExactPlane(a, b, c).value(d); }
Dyadic orientation_value(Vec3 a, Vec3 b, Vec3 c, const ExactPoint& d) { return ExactPlane(a, b, c).value(d); }

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

namespace {

// A point in space or in a plane in float64, with its error.
struct Known {
  Vec3 at, error;
};

constexpr int kOpen = 2;  // float64 does not decide the sign

// The one of orientation(a, b, c, d) in float64.
struct Determinant {
  double value, error;
};

Determinant rounded_determinant(Vec3 a, Vec3 b, Vec3 c, Known d) {
  const Vec3 u = b - a, v = c - a, p = d.at - a;
  const double yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z, xy = u.x * v.y,
               yx = u.y * v.x;
  const Vec3 size{std::fabs(yz) + std::fabs(zy), std::fabs(zx) + std::fabs(xz),
                  std::fabs(xy) + std::fabs(yx)};
  const double determinant = (yz - zy) * p.x + (zx - xz) * p.y + (xy - yx) * p.z;
  const Vec3 span{std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)};
  return {determinant, kSlack * (kDeterminantBound * dot(size, span) + dot(size, d.error)) + kUnderflow};
}

int filtered_orientation(Vec3 a, Vec3 b, Vec3 c, Known d) {
  const auto [determinant, bound] = rounded_determinant(a, b, c, d);
  return determinant > bound ? 1 : determinant < -bound ? -1 : kOpen;
}

}  // namespace

int orientation(Vec3 a, Vec3 b, Vec3 c, const ExactPoint& d, Budget* budget) {
  const int sign = filtered_orientation(a, b, c, {d.rounded, d.error});
  if (sign != kOpen) return sign;
  if (is_float64(d)) return orientation(a, b, c, d.rounded, budget);
  spend(budget, sign_work(d));
  return orientation_value(a, b, c, d).sign();
}

LazyPoint lazy_centroid(const std::array<Vec3, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const auto third = [](double x, double y, double z) { return (x + y + z) / 3; };
  // Two roundings, of at most 2 and 3 of the largest coordinate, are divided by 3, with one more: below 3 u of it.
  const auto error = [](double x, double y, double z) {
    return point_error(larger(std::fabs(x), larger(std::fabs(y), std::fabs(z))));
  };
  return {{third(a.x, b.x, c.x), third(a.y, b.y, c.y), third(a.z, b.z, c.z)},
          {error(a.x, b.x, c.x), error(a.y, b.y, c.y), error(a.z, b.z, c.z)},
          [&triangle] { return weighted_point(triangle[0], triangle[1], triangle[2], 1, 1, 1); }};
}

namespace {

// The point of the segment from p to q where a linear function with these values at the ends, of different signs, is 0.
LazyPoint lazy_zero(Known p, Known q, Determinant at_p, Determinant at_q, std::function<ExactPoint()> make) {
  const double sum = std::fabs(at_p.value) + std::fabs(at_q.value), error = at_p.error + at_q.error;
  if (!(sum > 4 * error)) {
    const ExactPoint exact = make();
    return {exact.rounded, exact.error, std::move(make)};
  }
  // The place t = P / (P + Q) on the way from p to q, with heights P and Q. If their error is at most a quarter of the
  // sum, |dt| <= 16/9 error / sum, plus 3 roundings.
  const double t = std::fabs(at_p.value) / sum, off = kSlack * (2 * error / sum + 4 * kRoundoff);
  const auto at = [&](double from, double to) { return from + (to - from) * t; };
  const auto error_at = [&](int k) {
    const double from = p.at[k], to = q.at[k], ends = larger(p.error[k], q.error[k]);
    return kSlack * ((std::fabs(to - from) + 2 * ends) * off + ends) + point_error(larger(std::fabs(from), std::fabs(to)));
  };
  return {{at(p.at.x, q.at.x), at(p.at.y, q.at.y), at(p.at.z, q.at.z)}, {error_at(0), error_at(1), error_at(2)}, std::move(make)};
}

}  // namespace

LazyPoint lazy_meeting_point(const std::array<Vec3, 3>& plane, const Vec3& p, const Vec3& q) {
  return lazy_meeting_point(plane, p, q, [&] { return plane_meeting_point(plane[0], plane[1], plane[2], p, q); });
}

LazyPoint lazy_meeting_point(const std::array<Vec3, 3>& plane, Vec3 p, Vec3 q, std::function<ExactPoint()> make) {
  return lazy_zero({p, {}}, {q, {}}, rounded_determinant(plane[0], plane[1], plane[2], {p, {}}),
                   rounded_determinant(plane[0], plane[1], plane[2], {q, {}}), std::move(make));
}

LazyPoint lazy_between(const LazyPoint& p, const LazyPoint& q, double wp, double wq) {
  const double t = wq / (wp + wq);
  const auto at = [&](double from, double to) { return from + (to - from) * t; };
  const auto error_at = [](double from, double to, double error) {
    return kSlack * (error + 2 * kRoundoff * std::fabs(to - from)) + point_error(larger(std::fabs(from), std::fabs(to)));
  };
  const Vec3 a = p.rounded, b = q.rounded;
  const Vec3 error{larger(p.error.x, q.error.x), larger(p.error.y, q.error.y), larger(p.error.z, q.error.z)};
  return {{at(a.x, b.x), at(a.y, b.y), at(a.z, b.z)},
          {error_at(a.x, b.x, error.x), error_at(a.y, b.y, error.y), error_at(a.z, b.z, error.z)},
          [&p, &q, wp, wq] { return between(p.exact(), q.exact(), wp, wq); }};
}

int orientation(Vec3 a, Vec3 b, Vec3 c, const LazyPoint& d, Budget* budget) {
  const int sign = filtered_orientation(a, b, c, {d.rounded, d.error});
  return sign != kOpen ? sign : orientation(a, b, c, d.exact(), budget);
}

namespace {

// (b - a) x (c - a) along the axis, in float64.
Determinant rounded_area(Known a, Known b, Known c, int drop_axis) {
  const auto [i, j] = plane_axes(drop_axis);
  const Vec3 u = b.at - a.at, v = c.at - a.at;
  const Vec3 eu = a.error + b.error, ev = a.error + c.error;
  const double left = u[i] * v[j], right = u[j] * v[i];
  const auto product_error = [](double x, double ex, double y, double ey) {
    return std::fabs(x) * ey + std::fabs(y) * ex + ex * ey;
  };
  return {left - right, kSlack * (kDeterminantBound * (std::fabs(left) + std::fabs(right)) +
                                  product_error(u[i], eu[i], v[j], ev[j]) + product_error(u[j], eu[j], v[i], ev[i])) + kUnderflow};
}

int filtered_orientation_2d(Known a, Known b, Known c, int drop_axis) {
  const auto [area, bound] = rounded_area(a, b, c, drop_axis);
  return area > bound ? 1 : area < -bound ? -1 : kOpen;
}

int exact_orientation_2d(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int drop_axis, Budget* budget) {
  const std::uint64_t digits = std::max({digits_of(a), digits_of(b), digits_of(c)});
  spend(budget, kAreaWork + kAreaDigitsWork * digits * digits);
  return area_value(a, b, c, drop_axis).sign();
}

Known known(const LazyPoint& p) { return {p.rounded, p.error}; }

}  // namespace

ExactPoint crossing_point(const ExactPoint& p, const ExactPoint& q, const ExactPoint& u, const ExactPoint& v, int drop_axis) {
  // The values are times the w of p and of q, and between() divides the weights by it.
  const Dyadic near = area_value(u, v, p, drop_axis) * q.w, far = area_value(u, v, q, drop_axis) * p.w;
  return near.sign() > 0 ? between(p, q, -far, near) : between(p, q, far, -near);
}

LazyPoint lazy_crossing(const LazyPoint& p, const LazyPoint& q, const LazyPoint& u, const LazyPoint& v, int drop_axis,
                        std::function<ExactPoint()> make) {
  return lazy_zero(known(p), known(q), rounded_area(known(u), known(v), known(p), drop_axis),
                   rounded_area(known(u), known(v), known(q), drop_axis), std::move(make));
}

int compare_along(const LazyPoint& p, const LazyPoint& q, int axis, Budget* budget) {
  const double gap = p.rounded[axis] - q.rounded[axis], error = kSlack * (p.error[axis] + q.error[axis]);
  if (gap > error) return 1;
  if (gap < -error) return -1;
  if (error == 0) return 0;
  const ExactPoint &a = p.exact(), &b = q.exact();
  const std::uint64_t digits = std::max(digits_of(a), digits_of(b));
  spend(budget, kCompareWork + kCompareDigitsWork * digits * digits);
  return (coordinate(a, axis) * b.w - coordinate(b, axis) * a.w).sign();
}

int orientation_2d_at(Vec3 a, Vec3 b, const ExactPoint& p, int drop_axis, Budget* budget) {
  const int sign = filtered_orientation_2d({a, {}}, {b, {}}, {p.rounded, p.error}, drop_axis);
  return sign != kOpen ? sign : orientation_2d_at(make_exact_point(a), make_exact_point(b), p, drop_axis, budget);
}

int orientation_2d_at(Vec3 a, Vec3 b, const LazyPoint& p, int drop_axis, Budget* budget) {
  const int sign = filtered_orientation_2d({a, {}}, {b, {}}, {p.rounded, p.error}, drop_axis);
  return sign != kOpen ? sign : orientation_2d_at(a, b, p.exact(), drop_axis, budget);
}

int orientation_2d_at(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int drop_axis, Budget* budget) {
  if (is_float64(a) && is_float64(b) && is_float64(c)) {
    return orientation_2d(a.rounded, b.rounded, c.rounded, drop_axis, budget);
  }
  const int sign = filtered_orientation_2d({a.rounded, a.error}, {b.rounded, b.error}, {c.rounded, c.error}, drop_axis);
  return sign != kOpen ? sign : exact_orientation_2d(a, b, c, drop_axis, budget);
}

int orientation_2d_at(const LazyPoint& a, const LazyPoint& b, const LazyPoint& c, int drop_axis, Budget* budget) {
  if (a.error == Vec3{} && b.error == Vec3{} && c.error == Vec3{}) {
    return orientation_2d(a.rounded, b.rounded, c.rounded, drop_axis, budget);
  }
  const int sign = filtered_orientation_2d(known(a), known(b), known(c), drop_axis);
  return sign != kOpen ? sign : exact_orientation_2d(a.exact(), b.exact(), c.exact(), drop_axis, budget);
}

namespace {

template <class Point>
bool in_triangle(const Point& p, Vec3 a, Vec3 b, Vec3 c, Budget* budget) {
  const int side = filtered_orientation(a, b, c, {p.rounded, p.error});
  if (side != kOpen) return false;
  return !collinear(a, b, c, budget) && plane_point_in_triangle(p, a, b, c, budget) && orientation(a, b, c, p, budget) == 0;
}

}  // namespace

bool point_in_triangle(const ExactPoint& p, Vec3 a, Vec3 b, Vec3 c, Budget* budget) { return in_triangle(p, a, b, c, budget); }
bool point_in_triangle(const LazyPoint& p, Vec3 a, Vec3 b, Vec3 c, Budget* budget) { return in_triangle(p, a, b, c, budget); }

Dyadic area_value(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int drop_axis) {
  const auto [i, j] = plane_axes(drop_axis);
  const auto difference = [&](const ExactPoint& p, int axis) {
    return coordinate(p, axis) * a.w - coordinate(a, axis) * p.w;
  };
  return difference(b, i) * difference(c, j) - difference(b, j) * difference(c, i);
}

}  // namespace satcheck
