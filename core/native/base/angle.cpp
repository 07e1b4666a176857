#include "base/angle.hpp"

#include <cmath>
#include <numbers>

namespace satcheck {
namespace {

// tan(a / 2) = t / (1 + sqrt(1 + t^2)) for t = tan(a). Halving three times leaves at most pi / 32, where the series of
// the arctangent has dropped to 2^-53 after nine terms. The quotient t has one roundoff, each halving adds fewer than 3.2
// and the series fewer than 1.2: less than 12 of an angle up to pi / 4, that is 9.5. The two differences from a quarter
// and from half a turn add fewer than 5, with the rounding of these constants.
constexpr int kHalvings = 3, kTerms = 9;

double arctangent(double t) {  // 0 <= t <= 1
  for (int k = 0; k < kHalvings; ++k) t /= 1 + std::sqrt(1 + t * t);
  const double square = t * t;
  double sum = 0;
  for (int k = kTerms; k > 0; --k) sum = square * (1.0 / (2 * k + 1) - sum);
  return (1 << kHalvings) * (t - t * sum);
}

}  // namespace

double direction_angle(double y, double x) {
  const double across = std::fabs(x), up = std::fabs(y);
  if (across == 0 && up == 0) return 0;
  double angle = up <= across ? arctangent(up / across) : std::numbers::pi / 2 - arctangent(across / up);
  if (x < 0) angle = std::numbers::pi - angle;
  return y < 0 ? -angle : angle;
}

double angle_of_cosine(double cosine) { return direction_angle(std::sqrt((1 - cosine) * (1 + cosine)), cosine); }

// The series of cos(a) - 1, whose terms drop below 2^-53 of the first for a <= pi / 4; twice the angle from there.
double cosine_of(double angle) {
  const bool halved = angle > std::numbers::pi / 4;
  const double square = (halved ? angle / 2 : angle) * (halved ? angle / 2 : angle);
  double less = 0;  // 1 - cos
  for (int k = 9; k > 0; --k) less = square / (2 * k * (2 * k - 1)) * (1 - less);
  return halved ? 1 - 4 * less + 2 * less * less : 1 - less;
}

}  // namespace satcheck
