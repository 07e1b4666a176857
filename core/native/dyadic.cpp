#include "dyadic.hpp"

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
  const auto low = std::find_if(limbs_.begin(), limbs_.end(), [](std::uint32_t l) { return l != 0; });
  exponent_ += kLimbBits * (low - limbs_.begin());
  limbs_.erase(limbs_.begin(), low);
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

Dyadic::Limbs Dyadic::shifted(const Limbs& a, std::int64_t bits) {
  const auto whole = static_cast<std::size_t>(bits / kLimbBits);
  const int part = static_cast<int>(bits % kLimbBits);
  Limbs result(whole, 0);
  result.reserve(whole + a.size() + 1);
  std::uint64_t carry = 0;
  for (const std::uint32_t limb : a) {
    carry |= static_cast<std::uint64_t>(limb) << part;
    result.push_back(static_cast<std::uint32_t>(carry));
    carry >>= kLimbBits;
  }
  if (carry != 0) result.push_back(static_cast<std::uint32_t>(carry));
  return result;
}

Dyadic operator+(const Dyadic& a, const Dyadic& b) {
  if (a.limbs_.empty()) return b;
  if (b.limbs_.empty()) return a;
  Dyadic result;
  result.exponent_ = std::min(a.exponent_, b.exponent_);
  const Dyadic::Limbs x = Dyadic::shifted(a.limbs_, a.exponent_ - result.exponent_);
  const Dyadic::Limbs y = Dyadic::shifted(b.limbs_, b.exponent_ - result.exponent_);
  const int order = Dyadic::compare(x, y);
  const Dyadic::Limbs& large = order >= 0 ? x : y;
  const Dyadic::Limbs& small = order >= 0 ? y : x;
  const bool subtract = a.negative_ != b.negative_;
  result.negative_ = order >= 0 ? a.negative_ : b.negative_;
  result.limbs_.reserve(large.size() + 1);
  std::int64_t carry = 0;
  for (std::size_t i = 0; i < large.size(); ++i) {
    const std::int64_t other = i < small.size() ? small[i] : 0;
    carry += static_cast<std::int64_t>(large[i]) + (subtract ? -other : other);
    result.limbs_.push_back(static_cast<std::uint32_t>(carry));
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
  result.limbs_.assign(a.limbs_.size() + b.limbs_.size(), 0);
  for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.limbs_.size(); ++j) {
      carry += static_cast<std::uint64_t>(a.limbs_[i]) * b.limbs_[j] + result.limbs_[i + j];
      result.limbs_[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= kLimbBits;
    }
    result.limbs_[i + b.limbs_.size()] = static_cast<std::uint32_t>(carry);
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
