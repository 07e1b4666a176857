// Random shapes and poses for the narrow-phase tests, seeded.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "convex/shape.hpp"

namespace satcheck::testing {

class Source {
 public:
  explicit Source(unsigned seed) : engine_(seed) {}

  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }
  Vec3 in_cube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3 on_sphere() {
    for (;;) {
      const Vec3 p = in_cube(1);
      const double length = norm(p);
      if (length > 0.1 && length <= 1) return p * (1 / length);
    }
  }

  Mat3 rotation() {
    double q[4], length = 0;
    for (double& c : q) {
      c = std::normal_distribution<double>()(engine_);
      length += c * c;
    }
    const double x = q[0], y = q[1], z = q[2], w = q[3], k = 2 / length;
    return {{{1 - k * (y * y + z * z), k * (x * y - z * w), k * (x * z + y * w)},
             {k * (x * y + z * w), 1 - k * (x * x + z * z), k * (y * z - x * w)},
             {k * (x * z - y * w), k * (y * z + x * w), 1 - k * (x * x + y * y)}}};
  }
  Pose pose(double spread) { return {rotation(), in_cube(spread)}; }

  std::vector<Vec3> sphere_points(int count) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back(on_sphere());
    return points;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace satcheck::testing
