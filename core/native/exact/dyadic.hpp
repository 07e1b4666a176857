// Integers times powers of two, of any size. Sums and products of float64 are such numbers.
#pragma once

#include <cstdint>

#include "exact/limbs.hpp"

namespace satcheck {

class Dyadic {
 public:
  Dyadic() = default;
  Dyadic(double value);  // exact; value must be finite

  int sign() const { return limbs_.empty() ? 0 : negative_ ? -1 : 1; }
  std::size_t digits() const { return limbs_.size(); }  // of 32 bits
  Dyadic operator-() const;

  friend Dyadic operator+(const Dyadic& a, const Dyadic& b);
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return sum(a, b, !b.negative_); }
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b);

  // numerator / denominator to within 2 ulp; 0 when it underflows.
  friend double rounded_ratio(const Dyadic& numerator, const Dyadic& denominator);

 private:
  // a + b, where b has the sign that is given.
  static Dyadic sum(const Dyadic& a, const Dyadic& b, bool b_is_negative);
  void trim();
  // The leading bits as a float64 in [2^63, 2^64) and the exponent that goes with it.
  double leading(std::int64_t& exponent) const;

  bool negative_ = false;
  std::int64_t exponent_ = 0;
  Limbs limbs_;  // least significant first, no leading zero; empty for zero
};

}  // namespace satcheck
