#include "exact/dyadic.hpp"

#include <algorithm>
#include <bit>
#include <cmath>


namespace satcheck {
namespace {

constexpr int kLimbBits = 32;
constexpr std::uint64_t kLimbMask = 0xFFFFFFFF;
// The format of a float64: mantissa * 2^(biased exponent - bias); the mantissa has 53 bits.
constexpr int kFractionBits = 52;
constexpr int kExponentMask = 0x7FF;
constexpr int kExponentBias = 1075;

}  // namespace

Dyadic::Dyadic(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto biased = static_cast<int>(bits >> kFractionBits & kExponentMask);
  auto mantissa = bits & ((std::uint64_t{1} << kFractionBits) - 1);
  if (biased != 0) mantissa |= std::uint64_t{1} << kFractionBits;
  if (mantissa == 0) return;
  const int zeros = std::countr_zero(mantissa);
  mantissa >>= zeros;
  exponent_ = std::max(biased, 1) - kExponentBias + zeros;
  negative_ = value < 0;
  limbs_.push_back(static_cast<std::uint32_t>(mantissa));
  if (mantissa >> kLimbBits != 0) limbs_.push_back(static_cast<std::uint32_t>(mantissa >> kLimbBits));
}

void Dyadic::trim() {
  while (!limbs_.empty() && limbs_.back() == 0) limbs_.pop_back();
  // Zero limbs at the low end are removed, because they would only make later products longer.
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

Dyadic operator+(const Dyadic& a, const Dyadic& b) { return Dyadic::sum(a, b, b.negative_); }

Dyadic Dyadic::sum(const Dyadic& a, const Dyadic& b, bool b_is_negative) {
  if (b.limbs_.empty()) return a;
  if (a.limbs_.empty()) {
    Dyadic result = b;
    result.negative_ = b_is_negative;
    return result;
  }
  const bool a_is_fine = a.exponent_ <= b.exponent_;
  const Dyadic &fine = a_is_fine ? a : b, &coarse = a_is_fine ? b : a;
  const bool subtract = a.negative_ != b_is_negative;
  // The digits of the coarser number move up by whole limbs and by bits.
  const std::int64_t shift = coarse.exponent_ - fine.exponent_;
  const auto whole = static_cast<std::size_t>(shift / kLimbBits);
  const int part = static_cast<int>(shift % kLimbBits);
  const std::size_t count_fine = fine.limbs_.size(), count_coarse = coarse.limbs_.size();
  Dyadic result;
  result.exponent_ = fine.exponent_;
  result.negative_ = a_is_fine ? a.negative_ : b_is_negative;
  result.limbs_.append_zeros(std::max(count_fine, whole + count_coarse + 1));
  const std::uint32_t *x = fine.limbs_.begin(), *y = coarse.limbs_.begin();
  std::uint32_t* digit = result.limbs_.begin();
  std::int64_t carry = 0;
  std::uint64_t moved = 0;
  for (std::size_t i = 0; i < result.limbs_.size(); ++i) {
    if (i >= whole && i - whole < count_coarse) moved |= static_cast<std::uint64_t>(y[i - whole]) << part;
    const auto other = static_cast<std::int64_t>(moved & kLimbMask);
    moved >>= kLimbBits;
    carry += static_cast<std::int64_t>(i < count_fine ? x[i] : 0) + (subtract ? -other : other);
    digit[i] = static_cast<std::uint32_t>(carry);
    carry >>= kLimbBits;  // arithmetic: -1 is a borrow
  }
  if (carry > 0) {
    result.limbs_.push_back(static_cast<std::uint32_t>(carry));
  } else if (carry < 0) {  // the coarser number is larger: the digits are those of 2^k minus the difference
    result.negative_ = !result.negative_;
    std::uint64_t one = 1;
    for (std::size_t i = 0; i < result.limbs_.size(); ++i) {
      one += static_cast<std::uint32_t>(~digit[i]);
      digit[i] = static_cast<std::uint32_t>(one);
      one >>= kLimbBits;
    }
  }
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
