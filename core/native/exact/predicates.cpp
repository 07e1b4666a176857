// Method: Jonathan R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
// Geometric Predicates" (1997): a float64 filter, then expansions. Where we deviate: one exact
// stage instead of an adaptive ladder, since zero elimination already keeps the expansions of
// grid-like input at one or two terms; and EXPANSION-SUM instead of FAST-EXPANSION-SUM, because it
// keeps terms nonadjacent through every operation used here (his theorems 12 and 19).
#include "exact/predicates.hpp"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <span>
#include <utility>

#include "base/lanes.hpp"
#include "exact/dyadic.hpp"

namespace satcheck {
namespace {

// What rounded_normal() promises, relative to the length of the normal.
constexpr double kNormalTolerance = 1e-14;

// Measured steps of a determinant of expansions: of any, and of each of its terms, which are more if exponents differ.
struct ExpansionWork {
  std::uint64_t any, term;
};
constexpr ExpansionWork kDeterminantWork{700, 200}, kMinorWork{100, 50};
// The same of integers times powers of two, with the steps that each pair of their digits adds; and how many 2x2
// determinants cost as much as a 3x3 one.
constexpr std::uint64_t kDyadicWork = 500, kDigitPairWork = 6, kDyadicMinors = 8;
constexpr int kDigitBits = 32;

// An unevaluated exact sum of nonoverlapping float64 terms, of increasing magnitude, none zero.
template <int Capacity>
struct Expansion {
  double term[Capacity];
  int size = 0;

  void append(double value) {
    if (value != 0) term[size++] = value;
  }
  // Adding from the smallest term up: a relative error of a few u.
  double rounded() const {
    double total = 0;
    for (int i = 0; i < size; ++i) total += term[i];
    return total;
  }
  int sign() const { return size == 0 ? 0 : term[size - 1] > 0 ? 1 : -1; }
};

// The expansion, after its steps are paid.
template <int Capacity>
const Expansion<Capacity>& paid(const Expansion<Capacity>& e, ExpansionWork work, Budget* budget) {
  spend(budget, work.any + work.term * static_cast<std::uint64_t>(e.size));
  return e;
}

struct Rounded {
  double value, error;
};

SATCHECK_INLINE Rounded two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  const double a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}

SATCHECK_INLINE Rounded two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

Expansion<2> difference(double a, double b) {
  const Rounded d = two_sum(a, -b);
  Expansion<2> result;
  result.append(d.error);
  result.append(d.value);
  return result;
}

template <int Capacity>
void grow(Expansion<Capacity>& e, double value) {
  double carry = value;
  int kept = 0;
  for (int i = 0; i < e.size; ++i) {
    const Rounded s = two_sum(carry, e.term[i]);
    carry = s.value;
    if (s.error != 0) e.term[kept++] = s.error;
  }
  e.size = kept;
  e.append(carry);
}

void grow(std::vector<double>& e, double value) {
  double carry = value;
  std::size_t kept = 0;
  for (const double part : e) {
    const Rounded s = two_sum(carry, part);
    carry = s.value;
    if (s.error != 0) e[kept++] = s.error;
  }
  e.resize(kept);
  if (carry != 0) e.push_back(carry);
}

template <int A, int B>
Expansion<A + B> sum(const Expansion<A>& e, const Expansion<B>& f) {
  Expansion<A + B> result;
  for (int i = 0; i < e.size; ++i) result.term[i] = e.term[i];
  result.size = e.size;
  for (int i = 0; i < f.size; ++i) grow(result, f.term[i]);
  return result;
}

template <int A>
Expansion<2 * A> scaled(const Expansion<A>& e, double factor) {
  Expansion<2 * A> result;
  if (e.size == 0) return result;
  Rounded carry = two_product(e.term[0], factor);
  result.append(carry.error);
  for (int i = 1; i < e.size; ++i) {
    const Rounded product = two_product(e.term[i], factor);
    const Rounded low = two_sum(carry.value, product.error);
    result.append(low.error);
    carry = two_sum(product.value, low.value);
    result.append(carry.error);
  }
  result.append(carry.value);
  return result;
}

template <int A>
Expansion<4 * A> product(const Expansion<A>& e, const Expansion<2>& f) {
  Expansion<4 * A> result;
  if (f.size == 0) return result;
  const Expansion<2 * A> low = scaled(e, f.term[0]);
  if (f.size == 2) return sum(low, scaled(e, f.term[1]));
  for (int i = 0; i < low.size; ++i) result.term[i] = low.term[i];
  result.size = low.size;
  return result;
}

template <int A>
Expansion<A> negated(Expansion<A> e) {
  for (int i = 0; i < e.size; ++i) e.term[i] = -e.term[i];
  return e;
}

struct ExactVector {
  Expansion<2> x, y, z;
};

ExactVector exact_difference(Vec3 head, Vec3 tail) {
  return {difference(head.x, tail.x), difference(head.y, tail.y), difference(head.z, tail.z)};
}

Expansion<16> exact_minor(const Expansion<2>& a, const Expansion<2>& b, const Expansion<2>& c,
                          const Expansion<2>& d) {
  return sum(product(a, d), negated(product(b, c)));  // a d - b c
}

Expansion<192> exact_determinant(Vec3 p1, Vec3 q1, Vec3 p2, Vec3 q2, Vec3 p3, Vec3 q3) {
  const ExactVector a = exact_difference(q1, p1);
  const ExactVector b = exact_difference(q2, p2);
  const ExactVector c = exact_difference(q3, p3);
  const Expansion<64> x = product(exact_minor(b.y, b.z, c.y, c.z), a.x);
  const Expansion<64> y = product(exact_minor(b.z, b.x, c.z, c.x), a.y);
  const Expansion<64> z = product(exact_minor(b.x, b.y, c.x, c.y), a.z);
  return sum(sum(x, y), z);
}

// Two different doubles of at least this size differ by a multiple of 1e-97. The terms of an exact product of three
// differences are then multiples of 1e-291, which float64 can hold. Expansions are exact only for such doubles.
constexpr double kSmallestFactor = 1e-80;

bool may_underflow(std::span<const Vec3> points) {
  const auto is_tiny = [](double c) { return c != 0 && std::fabs(c) < kSmallestFactor; };
  return std::any_of(points.begin(), points.end(), [&](Vec3 p) { return is_tiny(p.x) || is_tiny(p.y) || is_tiny(p.z); });
}
bool may_underflow(std::initializer_list<Vec3> points) { return may_underflow(std::span(points.begin(), points.size())); }

// The difference of two points as integers times powers of two, which never underflow.
DyadicVec dyadic_difference(Vec3 tail, Vec3 head) { return DyadicVec(head) - DyadicVec(tail); }

// More for coordinates whose differences are longer.
std::uint64_t dyadic_work(std::initializer_list<Vec3> points) {
  int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
  for (const Vec3 p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] == 0) continue;
      low = std::min(low, std::ilogb(p[axis]));
      high = std::max(high, std::ilogb(p[axis]));
    }
  }
  const auto digits = static_cast<std::uint64_t>(high > low ? 4 + (high - low) / kDigitBits : 4);
  return kDyadicWork + kDigitPairWork * digits * digits;
}

Dyadic dyadic_determinant(Vec3 p1, Vec3 q1, Vec3 p2, Vec3 q2, Vec3 p3, Vec3 q3) {
  return dot(dyadic_difference(p1, q1), cross(dyadic_difference(p2, q2), dyadic_difference(p3, q3)));
}

// The normal of the triangle, scaled by a power of two so that its longest component does not underflow. Only the
// direction matters.
Vec3 normal_of_tiny(Vec3 a, Vec3 b, Vec3 c) {
  const DyadicVec n = cross(dyadic_difference(a, b), dyadic_difference(a, c));
  for (Dyadic unit = 1;; unit = unit * Dyadic(0x1p-1000)) {
    const Vec3 normal{rounded_ratio(n.x, unit), rounded_ratio(n.y, unit), rounded_ratio(n.z, unit)};
    if (max_abs(normal) > 1e-150 || (n.x.sign() == 0 && n.y.sign() == 0 && n.z.sign() == 0)) return normal;
  }
}

double dyadic_volume(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  const Vec3 origin = vertices[triangles[0][0]];
  Dyadic total;
  for (const Triangle& t : triangles) {
    total = total + dyadic_determinant(origin, vertices[t[0]], origin, vertices[t[1]], origin, vertices[t[2]]);
  }
  const double volume = rounded_ratio(total, Dyadic(6));
  return volume == 0 && total.sign() != 0 ? std::copysign(std::numeric_limits<double>::denorm_min(), total.sign()) : volume;
}

// Whether a row or a column of the matrix is 0, as is usual for axis-aligned geometry. Rounded differences are 0 only
// if exact ones are.
bool has_zero_line(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 zero;
  return (a.x == 0 && b.x == 0 && c.x == 0) || (a.y == 0 && b.y == 0 && c.y == 0) ||
         (a.z == 0 && b.z == 0 && c.z == 0) || a == zero || b == zero || c == zero;
}

}  // namespace

int determinant_sign(Vec3 p1, Vec3 q1, Vec3 p2, Vec3 q2, Vec3 p3, Vec3 q3, Budget* budget) {
  const Vec3 a = q1 - p1, b = q2 - p2, c = q3 - p3;
  const double yz = b.y * c.z, zy = b.z * c.y;
  const double zx = b.z * c.x, xz = b.x * c.z;
  const double xy = b.x * c.y, yx = b.y * c.x;
  const double determinant = a.x * (yz - zy) + a.y * (zx - xz) + a.z * (xy - yx);
  const double permanent = std::fabs(a.x) * (std::fabs(yz) + std::fabs(zy)) +
                           std::fabs(a.y) * (std::fabs(zx) + std::fabs(xz)) +
                           std::fabs(a.z) * (std::fabs(xy) + std::fabs(yx));
  const double bound = kDeterminantBound * permanent + kUnderflow;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  if (permanent == 0 && has_zero_line(a, b, c)) return 0;
  if (may_underflow({p1, q1, p2, q2, p3, q3})) {
    if (budget != nullptr) budget->spend(dyadic_work({p1, q1, p2, q2, p3, q3}));
    return dyadic_determinant(p1, q1, p2, q2, p3, q3).sign();
  }
  return paid(exact_determinant(p1, q1, p2, q2, p3, q3), kDeterminantWork, budget).sign();
}

int orientation(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Budget* budget) { return determinant_sign(a, b, a, c, a, d, budget); }

int orientation_2d(Vec3 a, Vec3 b, Vec3 c, int drop_axis, Budget* budget) {
  const int i = drop_axis == 2 ? 0 : drop_axis + 1;
  const int j = drop_axis == 0 ? 2 : drop_axis - 1;
  const double left = (b[i] - a[i]) * (c[j] - a[j]);
  const double right = (b[j] - a[j]) * (c[i] - a[i]);
  const double determinant = left - right;
  const double bound = kOrientation2dBound * (std::fabs(left) + std::fabs(right)) + kUnderflow;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  if ((b[i] == a[i] || c[j] == a[j]) && (b[j] == a[j] || c[i] == a[i])) return 0;
  if (may_underflow({a, b, c})) {
    if (budget != nullptr) budget->spend(dyadic_work({a, b, c}) / kDyadicMinors);
    const DyadicVec u = dyadic_difference(a, b), v = dyadic_difference(a, c);
    return (u[i] * v[j] - u[j] * v[i]).sign();
  }
  const Expansion<16> minor = exact_minor(difference(b[i], a[i]), difference(b[j], a[j]), difference(c[i], a[i]),
                                          difference(c[j], a[j]));
  return paid(minor, kMinorWork, budget).sign();
}

int exact_turn_sign(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const auto lifted = [](Vec2 p) { return Vec3{p.x, p.y, 0}; };
  if (may_underflow({lifted(a), lifted(b), lifted(c), lifted(d)})) {
    return cross(dyadic_difference(lifted(a), lifted(b)), dyadic_difference(lifted(c), lifted(d))).z.sign();
  }
  return exact_minor(difference(b.x, a.x), difference(b.y, a.y), difference(d.x, c.x), difference(d.y, c.y)).sign();
}

bool collinear(Vec3 a, Vec3 b, Vec3 c, Budget* budget) {
  // For most triangles, a rounded component of the normal is clearly not 0.
  const Vec3 u = b - a, v = c - a;
  const auto is_clear = [](double left, double right) {
    return std::fabs(left - right) > kOrientation2dBound * (std::fabs(left) + std::fabs(right)) + kUnderflow;
  };
  if (is_clear(u.y * v.z, u.z * v.y) || is_clear(u.z * v.x, u.x * v.z) || is_clear(u.x * v.y, u.y * v.x)) return false;
  return orientation_2d(a, b, c, 0, budget) == 0 && orientation_2d(a, b, c, 1, budget) == 0 &&
         orientation_2d(a, b, c, 2, budget) == 0;
}

namespace {

// The normal of a triangle in float64.
struct PlainNormal {
  PlainNormal(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 u = b - a, v = c - a;
    value = cross(u, v);
    const double products = std::fabs(u.y * v.z) + std::fabs(u.z * v.y) + std::fabs(u.z * v.x) +
                            std::fabs(u.x * v.z) + std::fabs(u.x * v.y) + std::fabs(u.y * v.x);
    error = kOrientation2dBound * products + kUnderflow;
  }

  Vec3 value;
  double error;  // of each component, at most
};

}  // namespace

int projection_axis(Vec3 a, Vec3 b, Vec3 c, Budget* budget) {
  const PlainNormal normal(a, b, c);
  return projection_axis(normal.error < max_abs(normal.value) ? normal.value : rounded_normal(a, b, c, budget));
}

Vec3 rounded_normal(Vec3 a, Vec3 b, Vec3 c, Budget* budget) {
  const PlainNormal normal(a, b, c);
  if (normal.error <= kNormalTolerance * max_abs(normal.value)) return normal.value;
  if (may_underflow({a, b, c})) {
    if (budget != nullptr) budget->spend(3 * dyadic_work({a, b, c}) / kDyadicMinors);
    return normal_of_tiny(a, b, c);
  }
  const ExactVector p = exact_difference(b, a), q = exact_difference(c, a);
  return {paid(exact_minor(p.y, p.z, q.y, q.z), kMinorWork, budget).rounded(),
          paid(exact_minor(p.z, p.x, q.z, q.x), kMinorWork, budget).rounded(),
          paid(exact_minor(p.x, p.y, q.x, q.y), kMinorWork, budget).rounded()};
}

namespace {

// T. Ogita, S. M. Rump, S. Oishi, "Accurate Sum and Dot Product" (2005), Dot2.
SATCHECK_INLINE double compensated_affine(Vec3 a, Vec3 b, double offset) {
  double total = offset, correction = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Rounded p = two_product(a[axis], b[axis]);
    const Rounded s = two_sum(total, p.value);
    total = s.value;
    correction += s.error + p.error;
  }
  return total + correction;
}

SATCHECK_FUSED void round_affine(const Vec3 (&row)[3], Vec3 offset, Vec3* points, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = points[i];
    points[i] = {compensated_affine(row[0], p, offset.x), compensated_affine(row[1], p, offset.y),
                 compensated_affine(row[2], p, offset.z)};
  }
}

}  // namespace

double rounded_affine(Vec3 a, Vec3 b, double offset) { return compensated_affine(a, b, offset); }

void round_affine(const Vec3 (&row)[3], Vec3 offset, std::vector<Vec3>& points) {
  round_affine(row, offset, points.data(), points.size());
}

double signed_volume(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  if (triangles.empty()) return 0;
  const Vec3 origin = vertices[triangles[0][0]];
  VolumeSum sum(origin);
  for (const Triangle& t : triangles) sum.add(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  if (const auto volume = sum.volume()) return *volume;

  if (may_underflow(vertices)) return dyadic_volume(vertices, triangles);
  std::vector<double> exact;  // an expansion of unlimited length
  for (const Triangle& t : triangles) {
    const auto term = exact_determinant(origin, vertices[t[0]], origin, vertices[t[1]], origin,
                                        vertices[t[2]]);
    for (int i = 0; i < term.size; ++i) grow(exact, term.term[i]);
  }
  double rounded = 0;
  for (const double part : exact) rounded += part;
  return rounded / 6;
}

std::vector<std::vector<std::size_t>> groups_around(Vec3 p, Vec3 q, const std::vector<Vec3>& points, Budget* budget) {
  // 0: in the half-plane of the first point, 2: opposite it; 1 and 3: before and behind that.
  const auto quarter = [&](Vec3 point) {
    if (const int turn = orientation(p, q, points[0], point, budget)) return turn > 0 ? 1 : 3;
    for (int axis = 0; axis < 3; ++axis) {
      const int side = orientation_2d(p, q, points[0], axis, budget);
      if (side != 0) return side == orientation_2d(p, q, point, axis, budget) ? 0 : 2;
    }
    return 0;
  };
  std::vector<std::pair<int, std::size_t>> places;
  for (std::size_t k = 0; k < points.size(); ++k) places.emplace_back(quarter(points[k]), k);
  const auto turn = [&](const auto& from, const auto& to) {
    return orientation(p, q, points[from.second], points[to.second], budget);
  };
  std::stable_sort(places.begin(), places.end(), [&](const auto& from, const auto& to) {
    return from.first != to.first ? from.first < to.first : from.first % 2 == 1 && turn(from, to) > 0;
  });
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const bool coincides = k > 0 && places[k - 1].first == places[k].first && turn(places[k - 1], places[k]) == 0;
    if (!coincides) groups.emplace_back();
    groups.back().push_back(places[k].second);
  }
  return groups;
}

}  // namespace satcheck
