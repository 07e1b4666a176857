#include "depth/translation_box.hpp"

#include <cmath>

namespace satcheck {
namespace {

// The first box is larger than necessary by an odd factor, so that its halves do not end exactly at facets.
constexpr double kRootSize = 1.0309;
constexpr int kShortDigits = 20;

}  // namespace

Vec3 TranslationBox::nearest_to_origin() const {
  const auto clamp = [](double c, double h) { return c - h > 0 ? c - h : c + h < 0 ? c + h : 0.0; };
  return {clamp(centre.x, half.x), clamp(centre.y, half.y), clamp(centre.z, half.z)};
}

bool TranslationBox::contains(Vec3 t) const {
  const Vec3 d = t - centre;
  return std::fabs(d.x) <= half.x && std::fabs(d.y) <= half.y && std::fabs(d.z) <= half.z;
}

Vec3 in_plane(Vec3 t, int across) {
  switch (across) {
    case 0: return {0, t.y, t.z};
    case 1: return {t.x, 0, t.z};
    case 2: return {t.x, t.y, 0};
    default: return t;
  }
}

double root_half(double length) {
  int exponent = 0;
  const double fraction = std::frexp(kRootSize * length, &exponent);
  return std::ldexp(std::ceil(std::ldexp(fraction, kShortDigits)), exponent - kShortDigits);
}

}  // namespace satcheck
