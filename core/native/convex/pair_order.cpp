#include "convex/pair_order.hpp"

#include <algorithm>
#include <compare>
#include <utility>

namespace satcheck {

namespace {

// Coordinates are finite, so the order is total, except for the sign of zero, which has no effect.
std::partial_ordering order(Vec3 a, Vec3 b) {
  if (const auto by_x = a.x <=> b.x; by_x != 0) return by_x;
  if (const auto by_y = a.y <=> b.y; by_y != 0) return by_y;
  return a.z <=> b.z;
}

std::partial_ordering order(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return std::lexicographical_compare_three_way(a.begin(), a.end(), b.begin(), b.end(),
                                                [](Vec3 p, Vec3 q) { return order(p, q); });
}

std::partial_ordering order(const Shape& a, const Shape& b) {
  if (&a == &b) return std::partial_ordering::equivalent;
  if (a.kind != b.kind) return a.kind <=> b.kind;
  if (const auto by_size = order(a.size, b.size); by_size != 0) return by_size;
  if (const auto by_origin = order(a.origin, b.origin); by_origin != 0) return by_origin;
  return order(a.polytope.vertices, b.polytope.vertices);
}

std::partial_ordering order(const Pose& a, const Pose& b) {
  if (const auto by_place = order(a.translation, b.translation); by_place != 0) return by_place;
  for (int row = 0; row < 3; ++row) {
    if (const auto by_row = order(a.rotation.row[row], b.rotation.row[row]); by_row != 0) return by_row;
  }
  return std::partial_ordering::equivalent;
}

}  // namespace

bool comes_before_in_full(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const auto by_shape = order(a, b);
  return by_shape != 0 ? by_shape < 0 : order(pose_a, pose_b) <= 0;
}

void mirror(PairResult& result) {
  std::swap(result.index_a, result.index_b);
  std::swap(result.witness_a, result.witness_b);
  result.normal = Vec3{} - result.normal;  // no negative zeros
  if (result.feature == Feature::face_a || result.feature == Feature::face_b) {
    result.feature = result.feature == Feature::face_a ? Feature::face_b : Feature::face_a;
  }
}

}  // namespace satcheck
