#include "support_scan.hpp"

namespace satcheck {

VertexLanes::VertexLanes(const std::vector<Vec3>& points) {
  if (points.empty()) return;
  const std::size_t count = (points.size() + kLanes - 1) / kLanes * kLanes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = points[i < points.size() ? i : 0];
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
}

namespace {

// Folds lanes pairwise; conditional moves, because which lane wins is as good as random.
inline std::uint32_t first_best(double* best, double* where) {
  for (std::size_t half = VertexLanes::kLanes / 2; half > 0; half /= 2) {
    for (std::size_t l = 0; l < half; ++l) {
      const bool later = (best[l + half] > best[l]) |
                         ((best[l + half] == best[l]) & (where[l + half] < where[l]));
      best[l] = later ? best[l + half] : best[l];
      where[l] = later ? where[l + half] : where[l];
    }
  }
  return static_cast<std::uint32_t>(where[0]);
}

}  // namespace

#if defined(__GNUC__)

// Vector extensions of GCC and Clang: two groups of four lanes, each with its best value and the
// index where it stood, kept as float64 so that one mask selects both. Every lane multiplies and
// adds in the order of the plain code below: the same bits on every machine.
namespace {

typedef double Lanes __attribute__((vector_size(32)));
typedef double UnalignedLanes __attribute__((vector_size(32), aligned(8), may_alias));

// Clones pick wider registers at run time where the toolchain can; sanitizers and Clang cannot.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define SATCHECK_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define SATCHECK_WIDE
#endif

SATCHECK_WIDE std::uint32_t scan(const double* x, const double* y, const double* z, std::size_t count, double dx,
                                 double dy, double dz) {
  Lanes best0 = *reinterpret_cast<const UnalignedLanes*>(x) * dx + *reinterpret_cast<const UnalignedLanes*>(y) * dy +
                *reinterpret_cast<const UnalignedLanes*>(z) * dz;
  Lanes best1 = *reinterpret_cast<const UnalignedLanes*>(x + 4) * dx +
                *reinterpret_cast<const UnalignedLanes*>(y + 4) * dy +
                *reinterpret_cast<const UnalignedLanes*>(z + 4) * dz;
  Lanes where0 = {0, 1, 2, 3}, where1 = {4, 5, 6, 7};
  Lanes at0 = where0, at1 = where1;
  const Lanes step = {8, 8, 8, 8};
  for (std::size_t i = VertexLanes::kLanes; i < count; i += VertexLanes::kLanes) {
    at0 += step;
    at1 += step;
    const Lanes value0 = *reinterpret_cast<const UnalignedLanes*>(x + i) * dx +
                         *reinterpret_cast<const UnalignedLanes*>(y + i) * dy +
                         *reinterpret_cast<const UnalignedLanes*>(z + i) * dz;
    const Lanes value1 = *reinterpret_cast<const UnalignedLanes*>(x + i + 4) * dx +
                         *reinterpret_cast<const UnalignedLanes*>(y + i + 4) * dy +
                         *reinterpret_cast<const UnalignedLanes*>(z + i + 4) * dz;
    where0 = value0 > best0 ? at0 : where0;
    best0 = value0 > best0 ? value0 : best0;
    where1 = value1 > best1 ? at1 : where1;
    best1 = value1 > best1 ? value1 : best1;
  }
  double best[VertexLanes::kLanes], where[VertexLanes::kLanes];
  for (int l = 0; l < 4; ++l) {
    best[l] = best0[l];
    best[l + 4] = best1[l];
    where[l] = where0[l];
    where[l + 4] = where1[l];
  }
  return first_best(best, where);
}

}  // namespace

#else

namespace {

std::uint32_t scan(const double* x, const double* y, const double* z, std::size_t count, double dx, double dy,
                   double dz) {
  double best[VertexLanes::kLanes], where[VertexLanes::kLanes];
  for (std::size_t l = 0; l < VertexLanes::kLanes; ++l) {
    best[l] = x[l] * dx + y[l] * dy + z[l] * dz;
    where[l] = static_cast<double>(l);
  }
  for (std::size_t i = VertexLanes::kLanes; i < count; i += VertexLanes::kLanes) {
    for (std::size_t l = 0; l < VertexLanes::kLanes; ++l) {
      const double value = x[i + l] * dx + y[i + l] * dy + z[i + l] * dz;
      if (value > best[l]) {
        best[l] = value;
        where[l] = static_cast<double>(i + l);
      }
    }
  }
  return first_best(best, where);
}

}  // namespace

#endif

std::uint32_t support_index(const VertexLanes& v, Vec3 d) {
  return scan(v.x.data(), v.y.data(), v.z.data(), v.padded(), d.x, d.y, d.z);
}

}  // namespace satcheck
