// The depth of unions of whole boxes by enumeration: the slow truth about searches over translations.
#pragma once

#include <set>

#include "tests/boxes.hpp"

namespace satcheck::testing {

// Whether A moved by t and B have a common interior: one box of each does, because boxes are dense in their union.
inline bool overlap_after(const WholeBoxes& a, const WholeBoxes& b, Vec3 t) {
  const double move[3] = {t.x, t.y, t.z};
  return std::any_of(a.begin(), a.end(), [&](const WholeBox& p) {
    return std::any_of(b.begin(), b.end(), [&](const WholeBox& q) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!(p.low[axis] + move[axis] < q.high[axis] && q.low[axis] < p.high[axis] + move[axis])) return false;
      }
      return true;
    });
  });
}

// The length of the shortest translation of A that leaves no common interior. Free translations are a union of cells of
// the grid of all differences of faces: points, and intervals between them, along each axis.
inline double slow_depth(const WholeBoxes& a, const WholeBoxes& b) {
  std::vector<std::pair<double, double>> parts[3];  // a point of a part, and the coordinate in its closure nearest to 0
  for (int axis = 0; axis < 3; ++axis) {
    std::set<int> cuts;
    for (const WholeBox& p : a)
      for (const WholeBox& q : b) cuts.insert({q.low[axis] - p.high[axis], q.high[axis] - p.low[axis]});
    const std::vector<int> at(cuts.begin(), cuts.end());
    const auto part = [&](double inside, double low, double high) { parts[axis].emplace_back(inside, std::clamp(0.0, low, high)); };
    part(at.front() - 1, -INFINITY, at.front());
    part(at.back() + 1, at.back(), INFINITY);
    for (std::size_t k = 0; k < at.size(); ++k) {
      part(at[k], at[k], at[k]);
      if (k + 1 < at.size()) part((at[k] + at[k + 1]) * 0.5, at[k], at[k + 1]);
    }
  }
  double best = INFINITY;
  for (const auto& [x, near_x] : parts[0])
    for (const auto& [y, near_y] : parts[1])
      for (const auto& [z, near_z] : parts[2]) {
        const double length = std::sqrt(near_x * near_x + near_y * near_y + near_z * near_z);
        if (length < best && !overlap_after(a, b, {x, y, z})) best = length;
      }
  return best;
}

}  // namespace satcheck::testing
