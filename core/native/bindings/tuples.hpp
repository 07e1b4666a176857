// Points between C++ and Python: a vector is a tuple of three floats.
#pragma once

#include <array>
#include <stdexcept>
#include <tuple>

#include "base/vec.hpp"

namespace satcheck {

using Tuple3 = std::tuple<double, double, double>;

inline Vec3 to_vec(const std::array<double, 3>& c) { return {c[0], c[1], c[2]}; }
inline Tuple3 to_tuple(Vec3 v) { return {v.x, v.y, v.z}; }
inline Vec3 to_vec3(const Tuple3& t) { return {std::get<0>(t), std::get<1>(t), std::get<2>(t)}; }

// ValueError in Python when it is not finite.
inline Vec3 finite_point(const Tuple3& t) {
  const Vec3 p = to_vec3(t);
  if (!is_finite(p)) throw std::invalid_argument("the point is not finite");
  return p;
}

}  // namespace satcheck
