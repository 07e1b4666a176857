// Four float64 at a time. Every lane computes what plain code computes, in the same order. The bits are therefore equal
// on every machine, whatever the width of its registers.
#pragma once

#include <cmath>

#if defined(__GNUC__)
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

// A function with this mark is compiled twice, and the version for the machine's registers is chosen at run time.
// Functions on Lanes are inlined into both. Sanitizers and Clang do not support this.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define SATCHECK_WIDE __attribute__((target_clones("avx2", "default")))
// The same for an explicit fused multiply-add. Without such an instruction it is a function call.
#define SATCHECK_FUSED __attribute__((target_clones("fma", "default")))
#else
#define SATCHECK_WIDE
#define SATCHECK_FUSED
#endif
#define SATCHECK_INLINE inline __attribute__((always_inline))
#define SATCHECK_NOINLINE __attribute__((noinline))

// A warning about how Lanes are passed. It does not apply, because all functions are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace satcheck {

typedef double Lanes __attribute__((vector_size(32)));
typedef decltype(Lanes{} < Lanes{}) LaneMask;

SATCHECK_INLINE Lanes load_lanes(const double* from) {
  typedef double Unaligned __attribute__((vector_size(32), aligned(8), may_alias));
  return *reinterpret_cast<const Unaligned*>(from);
}
SATCHECK_INLINE void store_lanes(double* to, Lanes v) {
  typedef double Unaligned __attribute__((vector_size(32), aligned(8), may_alias));
  *reinterpret_cast<Unaligned*>(to) = v;
}
// Uses bit operations, because compilers split `mask ? a : b` lane by lane for narrow registers.
SATCHECK_INLINE Lanes select(LaneMask mask, Lanes a, Lanes b) {
  return (Lanes)((mask & (LaneMask)a) | (~mask & (LaneMask)b));
}
// The lanes a, b, c, d of a vector.
template <int a, int b, int c, int d>
SATCHECK_INLINE Lanes shuffle(Lanes v) {
#if defined(__clang__)
  return __builtin_shufflevector(v, v, a, b, c, d);
#else
  return __builtin_shuffle(v, LaneMask{a, b, c, d});
#endif
}

// The same for two vectors: 4 to 7 are the lanes of the second.
template <int a, int b, int c, int d>
SATCHECK_INLINE Lanes shuffle(Lanes u, Lanes v) {
#if defined(__clang__)
  return __builtin_shufflevector(u, v, a, b, c, d);
#else
  return __builtin_shuffle(u, v, LaneMask{a, b, c, d});
#endif
}

// Lane by lane. If the lanes are equal, or one is nan, the lane of b.
SATCHECK_INLINE Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }

SATCHECK_INLINE Lanes square_root(Lanes v) {
  return Lanes{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
}

SATCHECK_INLINE Lanes abs(Lanes v) { return (Lanes)((LaneMask)v & ~(LaneMask)Lanes{-0.0, -0.0, -0.0, -0.0}); }
// `size` is not negative.
SATCHECK_INLINE Lanes with_sign_of(Lanes sign, Lanes size) {
  return (Lanes)((LaneMask)size | ((LaneMask)sign & (LaneMask)Lanes{-0.0, -0.0, -0.0, -0.0}));
}

// Bit l is set if lane l of the mask is true.
SATCHECK_INLINE int bits_of(LaneMask mask) {
#if defined(__SSE2__)
  __m128d half[2];
  __builtin_memcpy(half, &mask, sizeof half);
  return _mm_movemask_pd(half[0]) | _mm_movemask_pd(half[1]) << 2;
#else
  return (mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8);
#endif
}

// Collects the masks of up to kVectors vectors: bit 4 k + l of bits() is lane l of vector k. All masks are combined at
// the end, which is faster than one by one.
class ManyLaneBits {
 public:
  static constexpr int kVectors = 16;
  SATCHECK_INLINE void add(LaneMask mask, int k) { bits_ |= mask & (LaneMask{1, 2, 4, 8} << 4 * k); }
  SATCHECK_INLINE unsigned long long bits() const {
    return static_cast<unsigned long long>((bits_[0] | bits_[2]) | (bits_[1] | bits_[3]));
  }

 private:
  LaneMask bits_ = {0, 0, 0, 0};
};

}  // namespace satcheck

#else  // plain code

#define SATCHECK_WIDE
#define SATCHECK_FUSED
#define SATCHECK_INLINE inline
#define SATCHECK_NOINLINE

namespace satcheck {

struct LaneMask {
  bool lane[4];
};
struct Lanes {
  double lane[4];
  double operator[](int l) const { return lane[l]; }
};

template <class Function>
Lanes each_lane(Function f) {
  return {{f(0), f(1), f(2), f(3)}};
}
inline Lanes operator+(Lanes a, Lanes b) { return each_lane([&](int l) { return a[l] + b[l]; }); }
inline Lanes operator-(Lanes a, Lanes b) { return each_lane([&](int l) { return a[l] - b[l]; }); }
inline Lanes operator*(Lanes a, Lanes b) { return each_lane([&](int l) { return a[l] * b[l]; }); }
inline Lanes operator/(Lanes a, Lanes b) { return each_lane([&](int l) { return a[l] / b[l]; }); }
inline Lanes operator*(Lanes a, double s) { return each_lane([&](int l) { return a[l] * s; }); }
inline Lanes operator-(Lanes a) { return each_lane([&](int l) { return -a[l]; }); }
inline LaneMask operator<(Lanes a, Lanes b) { return {{a[0] < b[0], a[1] < b[1], a[2] < b[2], a[3] < b[3]}}; }
inline LaneMask operator>(Lanes a, Lanes b) { return b < a; }
inline LaneMask operator<=(Lanes a, Lanes b) { return {{a[0] <= b[0], a[1] <= b[1], a[2] <= b[2], a[3] <= b[3]}}; }
inline LaneMask operator>=(Lanes a, Lanes b) { return b <= a; }
inline LaneMask operator==(Lanes a, Lanes b) { return {{a[0] == b[0], a[1] == b[1], a[2] == b[2], a[3] == b[3]}}; }
template <class Function>
LaneMask each_mask(Function f) {
  return {{f(0), f(1), f(2), f(3)}};
}
inline LaneMask operator&(LaneMask a, LaneMask b) { return each_mask([&](int l) { return a.lane[l] && b.lane[l]; }); }
inline LaneMask operator|(LaneMask a, LaneMask b) { return each_mask([&](int l) { return a.lane[l] || b.lane[l]; }); }
inline Lanes square_root(Lanes v) { return each_lane([&](int l) { return std::sqrt(v[l]); }); }
inline Lanes abs(Lanes v) { return each_lane([&](int l) { return std::fabs(v[l]); }); }
inline Lanes with_sign_of(Lanes sign, Lanes size) {
  return each_lane([&](int l) { return std::copysign(size[l], sign[l]); });
}
inline Lanes load_lanes(const double* from) { return {{from[0], from[1], from[2], from[3]}}; }
inline void store_lanes(double* to, Lanes v) {
  for (int l = 0; l < 4; ++l) to[l] = v[l];
}
inline Lanes select(LaneMask mask, Lanes a, Lanes b) {
  return each_lane([&](int l) { return mask.lane[l] ? a[l] : b[l]; });
}
inline Lanes larger(Lanes a, Lanes b) { return select(a > b, a, b); }
template <int a, int b, int c, int d>
Lanes shuffle(Lanes v) {
  return {{v[a], v[b], v[c], v[d]}};
}
template <int a, int b, int c, int d>
Lanes shuffle(Lanes u, Lanes v) {
  const auto lane = [&](int l) { return l < 4 ? u[l] : v[l - 4]; };
  return {{lane(a), lane(b), lane(c), lane(d)}};
}
inline int bits_of(LaneMask m) { return m.lane[0] | m.lane[1] << 1 | m.lane[2] << 2 | m.lane[3] << 3; }
class ManyLaneBits {
 public:
  static constexpr int kVectors = 16;
  void add(LaneMask mask, int k) { bits_ |= static_cast<unsigned long long>(bits_of(mask)) << 4 * k; }
  unsigned long long bits() const { return bits_; }

 private:
  unsigned long long bits_ = 0;
};

}  // namespace satcheck

#endif

namespace satcheck {

SATCHECK_INLINE Lanes all_lanes(double value) { return Lanes{value, value, value, value}; }
SATCHECK_INLINE Lanes smaller(Lanes a, Lanes b) { return select(a < b, a, b); }

}  // namespace satcheck
