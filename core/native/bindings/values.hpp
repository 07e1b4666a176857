// Values between C++ and Python: a vector is a tuple of three floats, an outcome is a word.
#pragma once

#include <array>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "base/best_first.hpp"
#include "base/vec.hpp"
#include "convex/narrow_phase.hpp"
#include "mesh_pair/mesh_pair.hpp"

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

inline const char* name_of(Outcome outcome) {
  constexpr const char* names[] = {"separated", "touching", "penetrating", "undecided"};
  return names[static_cast<int>(outcome)];
}

inline const char* name_of(Method method) {
  constexpr const char* names[] = {"none", "sat", "gjk", "epa", "exact", "portal"};
  return names[static_cast<int>(method)];
}

inline const char* name_of(Feature feature) {
  constexpr const char* names[] = {"none", "face-a", "face-b", "edge-edge", "vertices", "curved"};
  return names[static_cast<int>(feature)];
}

inline const char* name_of(Relation relation) {
  constexpr const char* names[] = {"separated", "touching", "penetrating", "contains", "inside", "coincident"};
  return names[static_cast<int>(relation)];
}

inline constexpr const char* kStopSignature = "def stop(self) -> typing.Literal['narrow', 'decided', 'work spent']";
inline const char* name_of(SearchStop stop) {
  constexpr const char* names[] = {"narrow", "decided", "work spent"};
  return names[static_cast<int>(stop)];
}

}  // namespace satcheck
