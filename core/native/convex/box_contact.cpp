#include "convex/box_contact.hpp"

#include "base/tolerances.hpp"

namespace satcheck {

namespace {

// sin^2 of the angle of two edges from which on their crossing is well conditioned.
constexpr double kCrossing = 1e-6;

Vec3 unit(std::uint32_t i) { return {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}; }

// The corner of a box farthest along an axis of its frame. False where another one is as far.
struct Corner {
  Vec3 point;
  bool sole;
};

Corner corner_along(Vec3 half, Vec3 axis) {
  const auto signed_half = [](double h, double along) { return along < 0 ? -h : h; };
  const double least = std::fmin(std::fabs(axis.x), std::fmin(std::fabs(axis.y), std::fabs(axis.z)));
  return {{signed_half(half.x, axis.x), signed_half(half.y, axis.y), signed_half(half.z, axis.z)}, least > kSameFeature};
}

// Within the face across axis i, seen along it.
bool over_face(Vec3 p, Vec3 half, std::uint32_t i) {
  return (i == 0 || std::fabs(p.x) <= half.x) && (i == 1 || std::fabs(p.y) <= half.y) && (i == 2 || std::fabs(p.z) <= half.z);
}

}  // namespace

std::optional<Witnesses> sole_contact_of_boxes(const MinkowskiDifference& m, const SatResult& sat) {
  const Vec3 n = sat.axis, ha = m.a.size, hb = m.b.size, way = n * sat.penetration;
  const Pose& b_in_a = m.b_in_a;
  const Vec3 against = transpose_times(b_in_a.rotation, -n);  // the axis from B to A, frame of B
  if (sat.feature == Feature::face_a) {
    const Corner corner = corner_along(hb, against);
    const Vec3 on_b = b_in_a * corner.point, on_a = on_b + way;
    if (!corner.sole || !over_face(on_a, ha, sat.index_a)) return std::nullopt;
    return Witnesses{on_a, on_b};
  }
  if (sat.feature == Feature::face_b) {
    const Corner corner = corner_along(ha, n);
    const Vec3 on_b = corner.point - way;
    const Vec3 in_b = transpose_times(b_in_a.rotation, on_b - b_in_a.translation);
    if (!corner.sole || !over_face(in_b, hb, sat.index_b)) return std::nullopt;
    return Witnesses{corner.point, on_b};
  }
  // The middles of the two edges, and how far along each the crossing lies.
  const Vec3 e = unit(sat.index_a), f = unit(sat.index_b), f_in_a = b_in_a.rotation * f;
  const Vec3 corner_a = corner_along(ha, n).point, corner_b = corner_along(hb, against).point;
  const Vec3 middle_a = corner_a - e * dot(corner_a, e), middle_b = b_in_a * (corner_b - f * dot(corner_b, f));
  const Vec3 apart = middle_b - middle_a + way;
  const double sine_squared = norm_squared(cross(e, f_in_a)), cosine = dot(e, f_in_a);
  if (!(sine_squared > kCrossing)) return std::nullopt;
  const double along_e = dot(apart, e), along_f = dot(apart, f_in_a);
  const double s = (along_e - cosine * along_f) / sine_squared, u = (cosine * along_e - along_f) / sine_squared;
  if (!(std::fabs(s) <= dot(ha, e)) || !(std::fabs(u) <= dot(hb, f))) return std::nullopt;
  const Vec3 on_a = middle_a + e * s;
  return Witnesses{on_a, on_a - way};
}

}  // namespace satcheck
