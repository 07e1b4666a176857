// Integers times powers of two, of any size, their vectors and their quotients. Sums and products of float64 are such
// numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>

#include "base/vec.hpp"

namespace satcheck {

// The digits of a big integer, base 2^32. The object itself has room for the digits that exact predicates usually need,
// so that a sign costs no allocation.
class Limbs {
 public:
  Limbs() {}  // near_ stays uninitialized: only the first size() digits count
  Limbs(std::initializer_list<std::uint32_t> limbs) { append(limbs.begin(), limbs.size()); }
  Limbs(const Limbs& other) { append(other.begin(), other.size_); }
  Limbs(Limbs&& other) noexcept { take(other); }
  Limbs& operator=(const Limbs& other) {
    if (this == &other) return *this;
    size_ = 0;
    append(other.begin(), other.size_);
    return *this;
  }
  Limbs& operator=(Limbs&& other) noexcept {
    if (this == &other) return *this;
    far_.reset();
    take(other);
    return *this;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::uint32_t* begin() { return far_ ? far_.get() : near_; }
  const std::uint32_t* begin() const { return far_ ? far_.get() : near_; }
  const std::uint32_t* end() const { return begin() + size_; }
  std::uint32_t operator[](std::size_t i) const { return begin()[i]; }
  std::uint32_t back() const { return begin()[size_ - 1]; }

  void push_back(std::uint32_t limb) {
    reserve(size_ + 1);
    begin()[size_++] = limb;
  }
  void pop_back() { --size_; }
  void drop_front(std::size_t count) {
    std::copy(begin() + count, begin() + size_, begin());
    size_ -= count;
  }
  void append_zeros(std::size_t count) {
    reserve(size_ + count);
    std::fill_n(begin() + size_, count, 0u);
    size_ += count;
  }
  void append(const std::uint32_t* limbs, std::size_t count) {
    reserve(size_ + count);
    std::copy_n(limbs, count, begin() + size_);
    size_ += count;
  }
  void reserve(std::size_t capacity) {
    if (capacity <= capacity_) return;
    capacity_ = std::max(capacity, 2 * capacity_);
    auto wider = std::make_unique_for_overwrite<std::uint32_t[]>(capacity_);
    std::copy_n(begin(), size_, wider.get());
    far_ = std::move(wider);
  }

 private:
  // A sample between two meeting points has coordinates of degree 8: 27 limbs if the exponents are similar.
  static constexpr std::size_t kNear = 32;

  void take(Limbs& other) {
    size_ = std::exchange(other.size_, 0);
    capacity_ = std::exchange(other.capacity_, kNear);
    if (other.far_) {
      far_ = std::move(other.far_);
    } else {
      std::copy_n(other.near_, size_, near_);
    }
  }

  std::size_t size_ = 0, capacity_ = kNear;
  std::unique_ptr<std::uint32_t[]> far_;  // used instead of near_ if that is too small
  std::uint32_t near_[kNear];
};

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

// Vectors without rounding.
struct DyadicVec {
  Dyadic x, y, z;

  DyadicVec() = default;
  DyadicVec(Dyadic px, Dyadic py, Dyadic pz) : x(std::move(px)), y(std::move(py)), z(std::move(pz)) {}
  explicit DyadicVec(Vec3 p) : x(p.x), y(p.y), z(p.z) {}

  DyadicVec operator-() const { return {-x, -y, -z}; }
  const Dyadic& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

inline DyadicVec operator+(const DyadicVec& a, const DyadicVec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline DyadicVec operator-(const DyadicVec& a, const DyadicVec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline DyadicVec operator*(const DyadicVec& a, const Dyadic& s) { return {a.x * s, a.y * s, a.z * s}; }
inline Dyadic dot(const DyadicVec& a, const DyadicVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline DyadicVec cross(const DyadicVec& a, const DyadicVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A quotient of dyadic numbers: a place on a segment, compared exactly. denominator > 0.
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
