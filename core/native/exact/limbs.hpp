// The digits of a big integer, base 2^32. The object itself has room for the digits that exact predicates usually need,
// so that a sign costs no allocation.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>

namespace satcheck {

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

}  // namespace satcheck
