// Small meshes that several tests need.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "base/mesh.hpp"

namespace satcheck::testing {

inline std::vector<Vec3> box_corners(Vec3 low, Vec3 high) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) points.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  return points;
}

inline Mesh box(Vec3 low, Vec3 high) {
  Mesh mesh{box_corners(low, high), {}};
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline void append(Mesh& mesh, const Mesh& other) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& t : other.triangles) {
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
}

// A random point of the hull of these points. The third power prefers the neighbourhood of single corners.
inline Vec3 random_in_hull(std::mt19937& generator, const std::vector<Vec3>& points) {
  std::exponential_distribution<double> weight;
  Vec3 p;
  double sum = 0;
  for (const Vec3& v : points) {
    const double w = std::pow(weight(generator), 3);
    p = p + v * w;
    sum += w;
  }
  return p * (1 / sum);
}

inline Mesh reversed(Mesh mesh) {
  for (Triangle& t : mesh.triangles) t = {t[0], t[2], t[1]};
  return mesh;
}

// A sphere of about 4 * n^2 triangles, radius 1.
inline Mesh uv_sphere(std::uint32_t n) {
  Mesh mesh;
  const double pi = 3.141592653589793;
  mesh.vertices.push_back({0, 0, 1});
  for (std::uint32_t i = 1; i < n; ++i) {
    for (std::uint32_t j = 0; j < 2 * n; ++j) {
      const double polar = pi * i / n, around = pi * j / n;
      mesh.vertices.push_back({std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar)});
    }
  }
  mesh.vertices.push_back({0, 0, -1});
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return 1 + (i - 1) * 2 * n + j % (2 * n); };
  for (std::uint32_t j = 0; j < 2 * n; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({last, at(n - 1, j + 1), at(n - 1, j)});
    for (std::uint32_t i = 1; i + 1 < n; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

}  // namespace satcheck::testing
