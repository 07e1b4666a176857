// Points and boxes between C++ and Python: a vector is a tuple of three floats.
#pragma once

#include <array>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

using Tuple3 = std::tuple<double, double, double>;
using Triple = std::array<double, 3>;
using Box = std::pair<Triple, Triple>;  // the least and the greatest corner

inline Vec3 to_vec(const Triple& c) { return {c[0], c[1], c[2]}; }
inline Tuple3 to_tuple(Vec3 v) { return {v.x, v.y, v.z}; }
inline Vec3 to_vec3(const Tuple3& t) { return {std::get<0>(t), std::get<1>(t), std::get<2>(t)}; }

inline std::vector<Tuple3> to_tuples(const std::vector<Vec3>& points) {
  std::vector<Tuple3> tuples;
  for (const Vec3 p : points) tuples.push_back(to_tuple(p));
  return tuples;
}

inline Aabb to_aabb(const Box& box) { return {to_vec(box.first), to_vec(box.second)}; }

// ValueError in Python when it is not finite.
inline Vec3 finite_point(const Tuple3& t) {
  const Vec3 p = to_vec3(t);
  if (!is_finite(p)) throw std::invalid_argument("the point is not finite");
  return p;
}

}  // namespace satcheck
