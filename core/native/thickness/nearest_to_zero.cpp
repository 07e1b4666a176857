// By all its corners, edges, triangles and tetrahedra.
#include "thickness/nearest_to_zero.hpp"

#include <cmath>

namespace satcheck {
namespace {

// Sines and volumes below this belong to needles and flat tetrahedra.
constexpr double kThin = 1e-4;

}  // namespace

Vec3 nearest_to_zero(const std::vector<Vec3>& of) {
  Vec3 best = of[0];
  const auto take = [&](Vec3 v) {
    if (norm_squared(v) < norm_squared(best)) best = v;
  };
  const auto n = of.size();
  for (std::size_t i = 0; i < n; ++i) {
    take(of[i]);
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vec3 e = of[j] - of[i];
      const double ee = dot(e, e), t = ee > 0 ? -dot(of[i], e) / ee : 0;
      if (t > 0 && t < 1) take(of[i] + e * t);
      for (std::size_t k = j + 1; k < n; ++k) {
        const Vec3 f = of[k] - of[i];
        const double ff = dot(f, f), ef = dot(e, f), determinant = ee * ff - ef * ef;
        if (!(determinant > kThin * kThin * ee * ff)) continue;
        const double re = -dot(of[i], e), rf = -dot(of[i], f);
        const double s = (re * ff - rf * ef) / determinant, u = (rf * ee - re * ef) / determinant;
        if (s > 0 && u > 0 && s + u < 1) take(of[i] + e * s + f * u);
        for (std::size_t l = k + 1; l < n; ++l) {
          const Vec3 g = of[l] - of[i], o = -of[i];
          const double volume = dot(e, cross(f, g));
          if (!(std::fabs(volume) > kThin)) continue;
          const double x = dot(o, cross(f, g)) / volume, y = dot(e, cross(o, g)) / volume, z = dot(e, cross(f, o)) / volume;
          if (x > 0 && y > 0 && z > 0 && x + y + z < 1) take(of[i] + e * x + f * y + g * z);
        }
      }
    }
  }
  return best;
}

}  // namespace satcheck
