// Vectors without rounding.
#pragma once

#include <utility>

#include "base/vec.hpp"
#include "exact/dyadic.hpp"

namespace satcheck {

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

}  // namespace satcheck
