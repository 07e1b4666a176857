#include "exact/dyadic.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace satcheck {
namespace {

constexpr int kLimbBits = 32;
constexpr int kMantissaBits = 53;

}  // namespace

Dyadic::Dyadic(double value) {
  if (value == 0) return;
  int exponent = 0;
  const double mantissa = std::frexp(std::fabs(value), &exponent);
  auto bits = static_cast<std::uint64_t>(std::ldexp(mantissa, kMantissaBits));
  const int zeros = std::countr_zero(bits);
  bits >>= zeros;
  exponent_ = exponent - kMantissaBits + zeros;
  negative_ = value < 0;
  limbs_ = {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> kLimbBits)};
  trim();
}

void Dyadic::trim() {
  while (!limbs_.empty() && limbs_.back() == 0) limbs_.pop_back();
  // Whole zero limbs at the low end carry nothing and would only make later products longer.
  const Limbs& limbs = limbs_;
  const auto low = std::find_if(limbs.begin(), limbs.end(), [](std::uint32_t l) { return l != 0; });
  if (low != limbs_.begin()) {
    exponent_ += kLimbBits * (low - limbs_.begin());
    limbs_.drop_front(static_cast<std::size_t>(low - limbs_.begin()));
  }
  if (limbs_.empty()) {
    negative_ = false;
    exponent_ = 0;
  }
}

Dyadic Dyadic::operator-() const {
  Dyadic result = *this;
  result.negative_ = !negative_ && !limbs_.empty();
  return result;
}

int Dyadic::compare(const Limbs& a, const Limbs& b) {
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  for (std::size_t i = a.size(); i-- > 0;) {
    if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  }
  return 0;
}

Limbs Dyadic::shifted(const Limbs& a, std::int64_t bits) {
  const auto whole = static_cast<std::size_t>(bits / kLimbBits);
  const int part = static_cast<int>(bits % kLimbBits);
  Limbs result;
  result.reserve(whole + a.size() + 1);
  result.append_zeros(whole);
  std::uint64_t carry = 0;
  for (const std::uint32_t limb : a) {
    carry |= static_cast<std::uint64_t>(limb) << part;
    result.push_back(static_cast<std::uint32_t>(carry));
    carry >>= kLimbBits;
  }
  if (carry != 0) result.push_back(static_cast<std::uint32_t>(carry));
  return result;
}

Dyadic operator+(const Dyadic& a, const Dyadic& b) { return Dyadic::sum(a, b, b.negative_); }

Dyadic Dyadic::sum(const Dyadic& a, const Dyadic& b, bool b_is_negative) {
  if (b.limbs_.empty()) return a;
  if (a.limbs_.empty()) {
    Dyadic result = b;
    result.negative_ = b_is_negative;
    return result;
  }
  Dyadic result;
  result.exponent_ = std::min(a.exponent_, b.exponent_);
  const Limbs x = shifted(a.limbs_, a.exponent_ - result.exponent_);
  const Limbs y = shifted(b.limbs_, b.exponent_ - result.exponent_);
  const int order = compare(x, y);
  const Limbs& large = order >= 0 ? x : y;
  const Limbs& small = order >= 0 ? y : x;
  const bool subtract = a.negative_ != b_is_negative;
  result.negative_ = order >= 0 ? a.negative_ : b_is_negative;
  result.limbs_.append_zeros(large.size());
  std::uint32_t* digit = result.limbs_.begin();
  std::int64_t carry = 0;
  for (std::size_t i = 0; i < large.size(); ++i) {
    const std::int64_t other = i < small.size() ? small[i] : 0;
    carry += static_cast<std::int64_t>(large[i]) + (subtract ? -other : other);
    digit[i] = static_cast<std::uint32_t>(carry);
    carry >>= kLimbBits;  // arithmetic: -1 is a borrow
  }
  if (carry != 0) result.limbs_.push_back(static_cast<std::uint32_t>(carry));
  result.trim();
  return result;
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  Dyadic result;
  if (a.limbs_.empty() || b.limbs_.empty()) return result;
  result.negative_ = a.negative_ != b.negative_;
  result.exponent_ = a.exponent_ + b.exponent_;
  const std::size_t count_a = a.limbs_.size(), count_b = b.limbs_.size();
  result.limbs_.append_zeros(count_a + count_b);
  const std::uint32_t *x = a.limbs_.begin(), *y = b.limbs_.begin();
  std::uint32_t* digit = result.limbs_.begin();
  for (std::size_t i = 0; i < count_a; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < count_b; ++j) {
      carry += static_cast<std::uint64_t>(x[i]) * y[j] + digit[i + j];
      digit[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= kLimbBits;
    }
    digit[i + count_b] = static_cast<std::uint32_t>(carry);
  }
  result.trim();
  return result;
}

double Dyadic::leading(std::int64_t& exponent) const {
  const auto at = [&](std::size_t from_top) -> std::uint64_t {
    return from_top < limbs_.size() ? limbs_[limbs_.size() - 1 - from_top] : 0;
  };
  const int zeros = std::countl_zero(limbs_.back());
  std::uint64_t bits = (at(0) << kLimbBits) | at(1);
  if (zeros != 0) bits = (bits << zeros) | (at(2) >> (kLimbBits - zeros));
  exponent = exponent_ + kLimbBits * (static_cast<std::int64_t>(limbs_.size()) - 2) - zeros;
  return static_cast<double>(bits);
}

double rounded_ratio(const Dyadic& numerator, const Dyadic& denominator) {
  if (numerator.limbs_.empty()) return 0;
  std::int64_t up = 0, down = 0;
  const double quotient = numerator.leading(up) / denominator.leading(down);
  constexpr std::int64_t kClamp = 5000;  // far beyond the range of float64 either way
  const auto shift = static_cast<int>(std::clamp(up - down, -kClamp, kClamp));
  const double magnitude = std::ldexp(quotient, shift);
  return numerator.negative_ != denominator.negative_ ? -magnitude : magnitude;
}

}  // namespace satcheck
