// Quotients of dyadic numbers: places on a segment, compared exactly.
#pragma once

#include <utility>

#include "exact/dyadic.hpp"

namespace satcheck {

// numerator / denominator, denominator > 0.
struct Ratio {
  Dyadic numerator, denominator;
};

inline bool less(const Ratio& a, const Ratio& b) {
  return (a.numerator * b.denominator - b.numerator * a.denominator).sign() < 0;
}

inline double rounded(const Ratio& r) { return rounded_ratio(r.numerator, r.denominator); }

inline Ratio make_ratio(Dyadic numerator, Dyadic denominator) {
  if (denominator.sign() < 0) return {-numerator, -denominator};
  return {std::move(numerator), std::move(denominator)};
}

// The place on a segment where a linear function is 0. Its values at the ends have different signs.
inline Ratio zero_between(const Dyadic& at_start, const Dyadic& at_end) {
  return make_ratio(at_start, at_start - at_end);
}

}  // namespace satcheck
