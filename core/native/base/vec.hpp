// Vectors, rotations and rigid poses in float64, world frame right-handed.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace satcheck {

struct Vec3 {
  double x = 0, y = 0, z = 0;

  double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  double& at(int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  bool operator==(const Vec3&) const = default;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec3 operator*(double s, Vec3 a) { return a * s; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm_squared(Vec3 a) { return dot(a, a); }
inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
// The norm of a vector whose squares may be beyond float64, as std::hypot but with the same bits on every system. Off by
// at most 4 roundoffs.
inline double scaled_norm(Vec3 a) {
  const double squared = norm_squared(a);
  if (squared > 0x1p-900 && squared < 0x1p1000) return std::sqrt(squared);
  const double scale = squared < 1 ? 0x1p600 : 0x1p-600;
  const Vec3 scaled{a.x * scale, a.y * scale, a.z * scale};
  return norm(scaled) / scale;
}
// Plain comparisons are one instruction each, while fmax() is a function call.
inline double larger(double a, double b) { return a > b ? a : b; }
inline double smaller(double a, double b) { return a < b ? a : b; }
inline double max_abs(Vec3 a) { return larger(std::fabs(a.x), larger(std::fabs(a.y), std::fabs(a.z))); }

struct Vec2 {
  double x = 0, y = 0;
};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
inline Vec2 operator*(Vec2 a, double s) { return {a.x * s, a.y * s}; }
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

// An order of points that no scaling changes: by x, then y, then z.
inline bool coordinates_less(Vec3 a, Vec3 b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }
inline bool is_finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

// A unit vector perpendicular to `along`, from the coordinate axis that is least aligned with it.
inline Vec3 any_perpendicular(Vec3 along) {
  const double x = std::fabs(along.x), y = std::fabs(along.y), z = std::fabs(along.z);
  const Vec3 other = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 p = cross(along, other);
  return p * (1 / norm(p));
}

using Triangle = std::array<std::uint32_t, 3>;  // counter-clockwise seen from outside

inline constexpr std::uint32_t kNoIndex = 0xFFFFFFFF;  // of no vertex, edge or face

// Rows of a 3x3 matrix.
struct Mat3 {
  Vec3 row[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  bool operator==(const Mat3&) const = default;
};

inline Vec3 operator*(const Mat3& m, Vec3 v) { return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)}; }
inline Vec3 transpose_times(const Mat3& m, Vec3 v) { return m.row[0] * v.x + m.row[1] * v.y + m.row[2] * v.z; }

// Rigid placement: p_world = rotation * p_local + translation.
struct Pose {
  Mat3 rotation;
  Vec3 translation;
};

inline Vec3 operator*(const Pose& pose, Vec3 p) { return pose.rotation * p + pose.translation; }

struct Aabb {
  Vec3 min{INFINITY, INFINITY, INFINITY};
  Vec3 max{-INFINITY, -INFINITY, -INFINITY};

  void include(Vec3 p) { include(Aabb{p, p}); }
  void include(const Aabb& box) {  // an empty box changes nothing
    const Vec3 &low = box.min, &high = box.max;
    min = {low.x < min.x ? low.x : min.x, low.y < min.y ? low.y : min.y, low.z < min.z ? low.z : min.z};
    max = {high.x > max.x ? high.x : max.x, high.y > max.y ? high.y : max.y, high.z > max.z ? high.z : max.z};
  }
  // Whether all of the other box lies in this one; its sides may lie on sides of this one.
  bool contains(const Aabb& box) const {
    return min.x <= box.min.x && min.y <= box.min.y && min.z <= box.min.z && box.max.x <= max.x && box.max.y <= max.y &&
           box.max.z <= max.z;
  }
  Vec3 size() const { return max - min; }
  int widest_axis() const {
    const Vec3 s = size();
    return s.x >= s.y && s.x >= s.z ? 0 : s.y >= s.z ? 1 : 2;
  }
  Vec3 centre() const { return min * 0.5 + max * 0.5; }
  double largest_coordinate() const { return larger(max_abs(min), max_abs(max)); }
  Aabb widened(double by) const { return {min - Vec3{by, by, by}, max + Vec3{by, by, by}}; }
};

inline Aabb bounds_of(std::span<const Vec3> points) {  // empty without points
  Aabb box;
  for (const Vec3& p : points) box.include(p);
  return box;
}

// How far a box reaches from its centre along a direction.
inline double reach_along(Vec3 direction, Vec3 half) {
  return std::fabs(direction.x) * half.x + std::fabs(direction.y) * half.y + std::fabs(direction.z) * half.z;
}

// Closed boxes: boxes that share only a face, edge or corner meet.
inline bool meet(const Aabb& a, const Aabb& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

}  // namespace satcheck
