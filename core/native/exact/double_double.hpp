// Numbers of about 106 bits as unevaluated sums of two float64, for differences of products that cancel. T. J. Dekker,
// "A Floating-Point Technique for Extending the Available Precision"
// (1971); D. E. Knuth's two-sum; products by fused multiply-add, which is correct with or without
// hardware for it. Needs contraction to be off.
#pragma once

#include <cmath>

namespace satcheck {

struct DoubleDouble {
  double high = 0, low = 0;

  explicit operator double() const { return high + low; }
};

inline DoubleDouble exact_sum(double a, double b) {
  const double sum = a + b, back = sum - a;
  return {sum, (a - (sum - back)) + (b - back)};
}

inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble s = exact_sum(a.high, b.high);
  return exact_sum(s.high, s.low + (a.low + b.low));
}

inline DoubleDouble operator-(DoubleDouble a) { return {-a.high, -a.low}; }
inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }

inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const double product = a.high * b.high;
  const double error = std::fma(a.high, b.high, -product);
  return exact_sum(product, error + (a.high * b.low + a.low * b.high));
}

}  // namespace satcheck
